// What Photoneo's own aravis examples ask for (photoneo-3d/photoneo-cpp-examples, GigEV/aravis).

#include <cmath>
#include <map>
#include <string>

#include "tests/contract/gige_client.h"

namespace tubetwin {
namespace {

/// What the parts of TubeScan hold: the scan itself, its normals and how sure they are.
void CheckParts(const GigeReceived& frame) {
  const OrganizedCloud scan = TubeScan();
  REQUIRE(frame.parts.size() == 4);
  const GigePart &intensity = frame.parts[0], &range = frame.parts[1], &confidence = frame.parts[2],
                 &normal = frame.parts[3];
  CHECK(intensity.component == 1);
  CHECK(range.component == 4);
  CHECK(confidence.component == 6);
  CHECK(normal.component == 0xff00);
  for (const GigePart& part : frame.parts) {
    CHECK(part.width == kScanWidth);
    CHECK(part.height == kScanHeight);
  }
  for (std::size_t i = 0; i < kScanPixels; i += 7) {
    const Eigen::Vector3f& p = scan.p_SP[i];
    CHECK(intensity.At<std::uint16_t>(i) ==
          static_cast<std::uint16_t>(std::lround(scan.intensity[i] * 1023)));
    const float z_mm = range.At<float>(3 * i + 2);
    if (!IsValid(p)) {
      CHECK(z_mm == 0);
      CHECK(confidence.At<std::uint8_t>(i) == 0);
      continue;
    }
    CHECK(std::abs(z_mm - 1000 * p.z()) < 1e-3);
    CHECK(confidence.At<std::uint8_t>(i) > 0);
    // Around the tube's axis; on top of it and on the floor straight to the camera.
    const bool top = std::abs(p.x())<0.001f, floor = std::abs(p.x())> 0.015f;
    if (top || floor) CHECK(normal.At<float>(3 * i + 2) < -0.95f);
  }
}

TEST_CASE("Each component reaches aravis as a part, with the scan's values", "[contract]") {
  const GigeBench scanner;
  GigeClient client;
  CHECK(std::string(arv_camera_get_vendor_name(client.camera(), GigeFine("vendor"))) == "Photoneo");
  CHECK(std::string(arv_camera_get_model_name(client.camera(), GigeFine("model"))) ==
        "PhoXi3DScan");
  // As root aravis takes packets from the interface, else from its port: both have to work.
  const bool by_port = GENERATE(false, true);
  if (by_port) {
    arv_camera_gv_set_stream_options(client.camera(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  }
  client.TriggerBySoftware();
  arv_camera_gv_set_packet_size_adjustment(client.camera(), ARV_GV_PACKET_SIZE_ADJUSTMENT_ALWAYS);
  for (const char* component : {"Intensity", "Range", "Confidence", "Normal"}) {
    client.Enable(component);
  }
  for (const char* component : {"CoordinateMapA", "CoordinateMapB"}) {
    client.Enable(component, false);
  }
  arv_camera_set_integer(client.camera(), "NormalsEstimationRadius", 1, GigeFine("radius"));
  CHECK(arv_camera_gv_is_multipart_supported(client.camera(), GigeFine("multi-part")));
  client.Multipart(true);
  CHECK(client.Start() == kScanPixels * (2 + 12 + 1 + 12));
  for (int shot = 0; shot < 2; ++shot) {
    const GigeReceived frame = client.Scan();
    CHECK(frame.payload == ARV_BUFFER_PAYLOAD_TYPE_MULTIPART);
    CheckParts(frame);
  }
}

TEST_CASE("Components are found by their names, and none is sent that is not enabled",
          "[contract]") {
  const GigeBench scanner;
  GigeClient client;
  client.TriggerBySoftware();
  guint count = 0;
  const char** names = arv_camera_dup_available_enumerations_as_strings(
      client.camera(), "ComponentSelector", &count, GigeFine("components"));
  std::map<std::string, gint64> ids;
  for (guint i = 0; i < count; ++i) {
    client.Enable(names[i]);
    ids[names[i]] = arv_camera_get_integer(client.camera(), "ComponentIDValue", GigeFine("id"));
  }
  g_free(names);
  CHECK(ids == std::map<std::string, gint64>{{"Intensity", 1},
                                             {"Range", 4},
                                             {"Confidence", 6},
                                             {"CoordinateMapA", 10},
                                             {"CoordinateMapB", 11},
                                             {"Normal", 0xff00}});
  client.Multipart(true);
  client.Start();
  const GigeReceived all = client.Scan();
  REQUIRE(all.parts.size() == 6);
  CHECK(all.parts[3].At<float>(5) == 5);                   // Column,
  CHECK(all.parts[4].At<float>(7 * kScanWidth + 5) == 7);  // and row.
  arv_camera_stop_acquisition(client.camera(), GigeFine("stop"));

  for (const char* off : {"Intensity", "Confidence", "CoordinateMapA", "CoordinateMapB"}) {
    client.Enable(off, false);
  }
  client.Set("Scan3dOutputMode", "ProjectedC");
  client.Set("ComponentSelector", "Range");
  CHECK(client.Get("PixelFormat") == "Coord3D_C32f");
  client.Set("ComponentSelector", "Normal");
  client.Set("PixelFormat", "Coord3D_AC8");
  CHECK(client.Start() == kScanPixels * (4 + 2));
  const GigeReceived two = client.Scan();
  REQUIRE(two.parts.size() == 2);
  CHECK(two.parts[0].component == 4);
  CHECK(two.parts[0].format == kPixelCoord3dC32f);
  CHECK(two.parts[1].component == 0xff00);
  CHECK(two.parts[1].format == kPixelCoord3dAc8);
}

TEST_CASE("Without parts the first component is an image, the others are its chunks",
          "[contract]") {
  const GigeBench scanner;
  GigeClient client;
  client.TriggerBySoftware();
  SECTION("one") {
    CHECK(client.Start() == kScanPixels * 12);  // As shipped.
    const GigeReceived frame = client.Scan();
    CHECK(frame.payload == ARV_BUFFER_PAYLOAD_TYPE_IMAGE);
    REQUIRE(frame.parts.size() == 1);
    CHECK(frame.parts[0].format == kPixelCoord3dAbc32f);
    CHECK(frame.chunk_bytes.empty());
  }
  SECTION("three") {
    client.Enable("Intensity");
    client.Enable("Confidence");
    CHECK(client.Start() == kScanPixels * (2 + 12 + 1) + 3 * 8);
    const GigeReceived frame = client.Scan();
    CHECK(frame.payload == ARV_BUFFER_PAYLOAD_TYPE_IMAGE);
    REQUIRE(frame.parts.size() == 1);
    CHECK(frame.parts[0].format == kPixelMono10);
    CHECK(frame.parts[0].At<std::uint16_t>(kScanPixels - 1) ==
          std::lround(TubeScan().intensity.back() * 1023));
    CHECK(frame.chunk_bytes == std::map<std::uint32_t, std::size_t>{
                                   {1, kScanPixels * 2}, {4, kScanPixels * 12}, {6, kScanPixels}});
  }
}

TEST_CASE("Without trigger frames come one after the other", "[contract]") {
  const GigeBench scanner;
  GigeClient client;
  arv_camera_set_acquisition_mode(client.camera(), ARV_ACQUISITION_MODE_CONTINUOUS,
                                  GigeFine("mode"));
  arv_camera_clear_triggers(client.camera(), GigeFine("triggers"));
  client.Enable("Intensity");
  client.Enable("Normal");
  client.Multipart(true);
  client.Start();
  for (int i = 0; i < 5; ++i) CHECK(client.Take().parts.size() == 3);
}

TEST_CASE("A client finds the largest packets, and frames come whole in any size", "[contract]") {
  const GigeBench scanner;
  GigeClient client;
  client.TriggerBySoftware();
  client.Enable("Intensity");
  client.Multipart(true);
  gint64 least = 0, most = 0;
  arv_camera_get_integer_bounds(client.camera(), "GevSCPSPacketSize", &least, &most,
                                GigeFine("bounds"));
  CHECK(least == 576);
  CHECK(most == 16000);
  arv_camera_gv_set_packet_size(client.camera(), 1500, GigeFine("packet size"));
  arv_camera_gv_auto_packet_size(client.camera(), GigeFine("largest packet"));
  CHECK(arv_camera_gv_get_packet_size(client.camera(), GigeFine("packet size")) >= 16000 - 4);
  for (const gint size : {576, 1500, 9000}) {
    arv_camera_gv_set_packet_size(client.camera(), size, GigeFine("packet size"));
    CHECK(arv_camera_gv_get_packet_size(client.camera(), GigeFine("packet size")) ==
          static_cast<guint>(size));
    client.Start();
    CHECK(client.Scan().parts.size() == 2);
    arv_camera_stop_acquisition(client.camera(), GigeFine("stop"));
  }
  GError* refused = nullptr;
  arv_camera_gv_set_packet_size(client.camera(), 20000, &refused);
  CHECK(refused != nullptr);
  g_clear_error(&refused);
}

TEST_CASE("User sets are saved and loaded by their names, and unknown ones refused", "[contract]") {
  const GigeBench scanner;
  GigeClient client;
  const auto save = [&client](const char* set, const char* text, double exposure_ms) {
    client.Set("UserSetSelector", set);
    client.Do("UserSetReset");
    client.Set("UserSetDescription", text);
    client.Set("OperationMode", "Camera");
    arv_camera_set_float(client.camera(), "CameraExposure", exposure_ms, GigeFine("exposure"));
    client.Set("CameraTextureSource", "LED");
    client.Do("UserSetSave");
  };
  const auto load = [&client](const char* set) {
    client.Set("UserSetSelector", set);
    client.Do("UserSetLoad");
    return client.Get("UserSetDescription") + " " +
           std::to_string(std::lround(1000 * arv_camera_get_float(client.camera(), "CameraExposure",
                                                                  GigeFine("exposure"))));
  };
  save("UserSet0", "My custom UserSet", 30.72);
  save("UserSet1", "My other custom UserSet", 40.96);
  CHECK(load("Default") == "as shipped 20480");
  CHECK(client.Get("OperationMode") == "Scanner");
  CHECK(load("UserSet0") == "My custom UserSet 30720");
  CHECK(client.Get("CameraTextureSource") == "LED");
  CHECK(load("UserSet1") == "My other custom UserSet 40960");
  GError* refused = nullptr;
  arv_camera_set_string(client.camera(), "UserSetSelector", "UserSet7", &refused);
  CHECK(refused != nullptr);
  g_clear_error(&refused);
  client.Set("UserSetSelector", "Default");
  arv_camera_execute_command(client.camera(), "UserSetSave", &refused);
  CHECK(refused != nullptr);
  g_clear_error(&refused);
}

TEST_CASE("What the examples read of the device is there", "[contract]") {
  const GigeBench scanner;
  {
    GigeClient client;
    const auto number = [&client](const char* feature) {
      return arv_camera_get_integer(client.camera(), feature, GigeFine(feature));
    };
    CHECK(number("Width") == kScanWidth);
    CHECK(number("Height") == kScanHeight);
    CHECK(number("SensorWidth") == kScanWidth);
    CHECK(number("IsPhoXi3DScanner_Val") == 1);
    CHECK(number("IsMotionCam3D_Val") == 0);
    CHECK(number("TLParamsLocked") == 0);
    gint width = 0, height = 0;
    arv_camera_get_sensor_size(client.camera(), &width, &height, GigeFine("sensor"));
    CHECK(width == kScanWidth);
    CHECK(height == kScanHeight);
    arv_camera_set_boolean(client.camera(), "EnableJumboFrames", TRUE, GigeFine("jumbo frames"));
    CHECK(arv_camera_get_boolean(client.camera(), "EnableJumboFrames", GigeFine("jumbo frames")));
    gint64 least = 0, most = 0;
    arv_camera_get_integer_bounds(client.camera(), "NormalsEstimationRadius", &least, &most,
                                  GigeFine("bounds"));
    CHECK(least == 0);
    CHECK(most == 4);
    CHECK_FALSE(arv_camera_is_feature_available(client.camera(), "ShutterMultiplier", nullptr));
    CHECK(std::string(arv_camera_get_string(client.camera(), "DeviceFirmwareVersion",
                                            GigeFine("firmware"))) == "1.13.0");
  }
  arv_update_device_list();
  REQUIRE(arv_get_n_devices() == 1);
  CHECK(std::string(arv_get_device_vendor(0)) == "Photoneo");
  CHECK(std::string(arv_get_device_id(0)) == "Photoneo-PhoXi3DScan-TWIN-001");
  CHECK(std::string(arv_get_device_address(0)) == "127.0.0.1");
}

}  // namespace
}  // namespace tubetwin
