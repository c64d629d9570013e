#pragma once

#include <arv.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hw_bridge/emulators/photoneo/scanner_gige_emulator.h"
#include "tests/support/catch.h"
#include "tests/support/fake_scanner.h"

// The emulated GigE Vision scanner and a client that knows nothing of this project: aravis.

namespace tubetwin {
inline constexpr int kScanWidth = 160, kScanHeight = 120, kScanPixels = kScanWidth * kScanHeight;

/// A tube of 25 mm on a floor, with a hole: normals that differ, and empty pixels.
inline OrganizedCloud TubeScan() {
  constexpr float kFloor_m = 0.45f, kRadius_m = 0.0125f;
  OrganizedCloud cloud;
  cloud.width = kScanWidth;
  cloud.height = kScanHeight;
  for (int i = 0; i < kScanPixels; ++i) {
    const float x = (static_cast<float>(i % kScanWidth) - 79.5f) / 80 * 0.05f;
    const float y = (static_cast<float>(i / kScanWidth) - 59.5f) / 80 * 0.05f;
    const float rise = std::abs(x) < kRadius_m ? std::sqrt(kRadius_m * kRadius_m - x * x) : 0;
    const bool hole = i % kScanWidth < 10 && i / kScanWidth < 10;
    cloud.p_SP.push_back(hole ? InvalidPoint()
                              : Eigen::Vector3f(x, y, kFloor_m - kRadius_m - rise));
    cloud.intensity.push_back(hole ? 0 : 0.2f + static_cast<float>(i) / kScanPixels / 2);
  }
  return cloud;
}

/// The scanner and the thread on which it runs.
class GigeBench {
 public:
  GigeBench() {
    device_.sees = TubeScan();
    ScannerGigeConfig config{"127.0.0.1", kScanWidth, kScanHeight, {}};
    config.optics.focal_px = 80 / 0.05 * 0.45;
    emulator_ = std::make_unique<ScannerGigeEmulator>(device_, config);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        device_.now += FromSeconds(0.005);
        emulator_->Tick(device_.now);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }

 private:
  FakeScanner device_;
  std::unique_ptr<ScannerGigeEmulator> emulator_;
  std::jthread thread_;  ///< Last: ends before what it uses.
};

/// Fails the test where aravis says that something went wrong.
class GigeFine {
 public:
  explicit GigeFine(const char* what) : what_(what) {}
  GigeFine(const GigeFine&) = delete;
  GigeFine& operator=(const GigeFine&) = delete;
  ~GigeFine() noexcept(false) {
    if (error_ == nullptr) return;
    const std::string why = error_->message;
    g_clear_error(&error_);
    FAIL(what_ << ": " << why);
  }
  operator GError**() { return &error_; }

 private:
  std::string what_;
  GError* error_ = nullptr;
};

struct GigeUnref {
  void operator()(gpointer object) const { g_object_unref(object); }
};

struct GigePart {
  int component = 0;
  std::uint32_t format = 0;
  int width = 0, height = 0;
  std::vector<std::byte> bytes;
  template <class Value>
  Value At(std::size_t index) const {
    Value value;
    REQUIRE((index + 1) * sizeof value <= bytes.size());
    std::memcpy(&value, bytes.data() + index * sizeof value, sizeof value);
    return value;
  }
};
struct GigeReceived {
  ArvBufferPayloadType payload = ARV_BUFFER_PAYLOAD_TYPE_UNKNOWN;
  std::vector<GigePart> parts;
  std::map<std::uint32_t, std::size_t> chunk_bytes;  ///< By id, for ids 1, 4, 6 and 0xff00.
};

inline std::vector<std::byte> BytesAt(const void* data, std::size_t size) {
  const auto* begin = static_cast<const std::byte*>(data);
  return {begin, begin + size};
}

class GigeClient {
 public:
  GigeClient() : camera_(arv_camera_new("127.0.0.1", GigeFine("connect"))) {
    REQUIRE(ARV_IS_CAMERA(camera_.get()));
  }
  ArvCamera* camera() const { return camera_.get(); }

  void Set(const char* feature, const char* value) {
    arv_camera_set_string(camera(), feature, value, GigeFine(feature));
  }
  std::string Get(const char* feature) {
    return arv_camera_get_string(camera(), feature, GigeFine(feature));
  }
  void Do(const char* command) { arv_camera_execute_command(camera(), command, GigeFine(command)); }
  void Enable(const char* component, bool yes = true) {
    Set("ComponentSelector", component);
    arv_camera_set_boolean(camera(), "ComponentEnable", yes, GigeFine("ComponentEnable"));
  }
  void TriggerBySoftware() {
    arv_camera_set_acquisition_mode(camera(), ARV_ACQUISITION_MODE_CONTINUOUS, GigeFine("mode"));
    arv_camera_set_trigger(camera(), "Software", GigeFine("trigger"));
  }
  void Multipart(bool yes) { arv_camera_gv_set_multipart(camera(), yes, GigeFine("multi-part")); }

  std::size_t Start(int buffers = 2) {
    stream_.reset();  // It closes its port at the camera, which is the next one's too.
    stream_.reset(arv_camera_create_stream(camera(), nullptr, nullptr, GigeFine("stream")));
    REQUIRE(ARV_IS_STREAM(stream_.get()));
    const std::size_t payload = arv_camera_get_payload(camera(), GigeFine("payload"));
    for (int i = 0; i < buffers; ++i) {
      arv_stream_push_buffer(stream_.get(), arv_buffer_new(payload, nullptr));
    }
    arv_camera_start_acquisition(camera(), GigeFine("start"));
    return payload;
  }
  void Trigger() { arv_camera_software_trigger(camera(), GigeFine("software trigger")); }

  GigeReceived Take() {
    constexpr guint64 kPatience_us = 10000000;
    ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_.get(), kPatience_us);
    REQUIRE(buffer != nullptr);
    REQUIRE(arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS);
    GigeReceived received;
    received.payload = arv_buffer_get_payload_type(buffer);
    for (guint i = 0; i < arv_buffer_get_n_parts(buffer); ++i) {
      GigePart part;
      part.component = static_cast<int>(arv_buffer_get_part_component_id(buffer, i));
      part.format = static_cast<std::uint32_t>(arv_buffer_get_part_pixel_format(buffer, i));
      part.width = arv_buffer_get_part_width(buffer, i);
      part.height = arv_buffer_get_part_height(buffer, i);
      std::size_t size = 0;
      const void* data = arv_buffer_get_part_data(buffer, i, &size);
      part.bytes = BytesAt(data, size);
      received.parts.push_back(std::move(part));
    }
    if (arv_buffer_has_chunks(buffer)) {
      for (const std::uint32_t id : {1u, 4u, 6u, 0xff00u}) {
        std::size_t size = 0;
        arv_buffer_get_chunk_data(buffer, id, &size);
        if (size > 0) received.chunk_bytes[id] = size;
      }
    }
    arv_stream_push_buffer(stream_.get(), buffer);
    return received;
  }
  GigeReceived Scan() {
    Trigger();
    return Take();
  }

 private:
  std::unique_ptr<ArvCamera, GigeUnref> camera_;
  std::unique_ptr<ArvStream, GigeUnref> stream_;  ///< Ends before the camera.
};

}  // namespace tubetwin
