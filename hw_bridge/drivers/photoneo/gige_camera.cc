#include "hw_bridge/drivers/photoneo/gige_camera.h"

#include <arv.h>

#include <atomic>
#include <utility>
#include <vector>

#include "hw_bridge/drivers/photoneo/range_frame.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr int kControlPort = 3956;
// One unanswered question takes aravis 2.5 s: no new one is asked after these times.
constexpr auto kPatience = std::chrono::milliseconds(5300);
// Shorter, because giving control back is not answered either then.
constexpr auto kControlPatience = std::chrono::milliseconds(2900);
// No packet for so long: the rest of the frame is not coming.
constexpr unsigned kRetentionUs = 500000;
constexpr std::size_t kMaxPayload = std::size_t{1} << 30;

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref>;

/// Where aravis says what went wrong.
class Problem {
 public:
  Problem() = default;
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;
  ~Problem() { g_clear_error(&error_); }
  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  std::string text() const { return error_ == nullptr ? "no reason given" : error_->message; }

 private:
  GError* error_ = nullptr;
};

const char* ToText(ArvBufferStatus status) {
  switch (status) {
    case ARV_BUFFER_STATUS_TIMEOUT:
      return "its packets ceased";
    case ARV_BUFFER_STATUS_MISSING_PACKETS:
      return "packets are missing";
    case ARV_BUFFER_STATUS_WRONG_PACKET_ID:
      return "packets are out of order";
    case ARV_BUFFER_STATUS_SIZE_MISMATCH:
      return "it does not fit the announced size";
    default:
      return "it was broken off";
  }
}

Owned<GInetAddress> AddressOf(const std::string& host) {
  Owned<GInetAddress> address(g_inet_address_new_from_string(host.c_str()));
  if (!address || g_inet_address_get_family(address.get()) != G_SOCKET_FAMILY_IPV4) {
    throw Error(ErrorKind::kConfig,
                "cell.scanner.host is '" + host + "', allowed is the scanner's IPv4 address");
  }
  return address;
}

/// The local address from which `device` is reached. Sends nothing.
Owned<GInetAddress> LocalAddressTo(GInetAddress* device, const std::string& name) {
  Problem problem;
  Owned<GSocketAddress> there(g_inet_socket_address_new(device, kControlPort));
  Owned<GSocket> socket(g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM,
                                     G_SOCKET_PROTOCOL_UDP, problem.out()));
  if (!socket || !g_socket_connect(socket.get(), there.get(), nullptr, problem.out())) {
    throw Error(ErrorKind::kDevice, name + ": no way leads there: " + problem.text());
  }
  Owned<GSocketAddress> here(g_socket_get_local_address(socket.get(), problem.out()));
  if (!here) throw Error(ErrorKind::kDevice, name + ": " + problem.text());
  GInetAddress* address = g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(here.get()));
  return Owned<GInetAddress>(G_INET_ADDRESS(g_object_ref(address)));
}

}  // namespace

struct GigeCamera::Impl {
  explicit Impl(const std::string& host) {
    const Owned<GInetAddress> there = AddressOf(host);
    name = "scanner " + host + ":" + std::to_string(kControlPort) + " (GigE Vision)";
    const Owned<GInetAddress> here = LocalAddressTo(there.get(), name);
    Problem problem;
    device.reset(ARV_GV_DEVICE(arv_gv_device_new(here.get(), there.get(), problem.out())));
    if (!device) {
      Fail("no GenICam description from it, the first that was asked for: " + problem.text());
    }
    // A program that was killed still has control until its heartbeat is missed, mostly for 3 s.
    while (!arv_gv_device_is_controller(device.get())) {
      RequireTime("control of it; another program has it", kControlPatience);
      arv_gv_device_take_control(device.get(), problem.out());
    }
    g_signal_connect(device.get(), "control-lost", G_CALLBACK(+[](ArvDevice*, gpointer flag) {
                       *static_cast<std::atomic<bool>*>(flag) = true;
                     }),
                     &lost);
    arv_gv_device_set_stream_options(device.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    Execute("AcquisitionStop");
    Configure();
    Start();
  }

  ~Impl() {
    if (!device) return;
    g_signal_handlers_disconnect_by_data(device.get(), &lost);
    // Giving up control, which comes last, ends the frames too. Asking for that by itself would be
    // one more question that a dead link leaves unanswered.
    stream.reset();
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(ErrorKind::kDevice, name + ": " + what);
  }
  void RequireTime(const std::string& awaited, SteadyClock::duration patience = kPatience) const {
    if (SteadyClock::now() - began < patience) return;
    Fail("took too long; awaited was " + awaited);
  }

  ArvDevice* base() const { return ARV_DEVICE(device.get()); }
  bool Has(const char* feature) const {
    Problem unreadable;
    return arv_device_is_feature_available(base(), feature, unreadable.out()) != FALSE;
  }
  std::string Get(const char* feature) const {
    Problem problem;
    const char* value = arv_device_get_string_feature_value(base(), feature, problem.out());
    if (problem || value == nullptr) Fail(std::string(feature) + ": " + problem.text());
    return value;
  }
  void Set(const char* feature, const char* value) const {
    RequireTime(std::string(feature) + " = " + value);
    Problem problem;
    arv_device_set_string_feature_value(base(), feature, value, problem.out());
    if (problem) Fail(std::string(feature) + " = " + value + ": " + problem.text());
  }
  void Execute(const char* command) const {
    Problem problem;
    arv_device_execute_command(base(), command, problem.out());
    if (problem) Fail(std::string(command) + ": " + problem.text());
  }

  void Configure();
  void SelectRange();
  void CheckUnits();
  void Start();
  NoFrame NoRange(ArvBuffer* buffer) const;
  ReceivedFrame Read(ArvBuffer* buffer) const;

  std::string name;
  SteadyClock::time_point began = SteadyClock::now();  ///< Connecting, or starting anew.
  std::atomic<bool> lost = false;
  Owned<ArvGvDevice> device;
  Owned<ArvStream> stream;
  guint range_id = 0;  ///< Component of the range image; 0: the camera does not say.
  double metres_per_unit = 1e-3;
};

void GigeCamera::Impl::Configure() {
  if (Has("AcquisitionMode")) Set("AcquisitionMode", "Continuous");
  if (Has("TriggerSelector")) Set("TriggerSelector", "FrameStart");
  Set("TriggerMode", "On");
  Set("TriggerSource", "Software");
  SelectRange();
  if (Has("Scan3dOutputMode")) Set("Scan3dOutputMode", "CalibratedABC_Grid");
  Set("PixelFormat", "Coord3D_ABC32f");
  CheckUnits();
  // Without parts a PhoXi sends components as chunks of an image that was not asked for.
  Problem problem;
  if (arv_device_is_feature_implemented(base(), "ArvGevSCCFGMultipart", problem.out()) &&
      !problem) {
    arv_device_set_boolean_feature_value(base(), "ArvGevSCCFGMultipart", TRUE, problem.out());
    if (problem) Fail("multi-part frames: " + problem.text());
  }
}

/// Only what is needed travels: the range image without texture, normals and the rest.
void GigeCamera::Impl::SelectRange() {
  if (!Has("ComponentSelector")) return;
  Problem problem;
  guint count = 0;
  const char** names = arv_device_dup_available_enumeration_feature_values_as_strings(
      base(), "ComponentSelector", &count, problem.out());
  const std::vector<std::string> components(names, names + (names == nullptr ? 0 : count));
  g_free(names);
  if (problem) Fail("ComponentSelector: " + problem.text());
  for (const std::string& component : components) {
    if (component == "Range") continue;
    Set("ComponentSelector", component.c_str());
    arv_device_set_boolean_feature_value(base(), "ComponentEnable", FALSE, problem.out());
    if (problem) Fail("ComponentEnable of " + component + ": " + problem.text());
  }
  Set("ComponentSelector", "Range");  // It stays selected for what follows.
  arv_device_set_boolean_feature_value(base(), "ComponentEnable", TRUE, problem.out());
  if (problem) Fail("ComponentEnable of Range: " + problem.text());
  if (Has("ComponentIDValue")) {
    range_id = static_cast<guint>(
        arv_device_get_integer_feature_value(base(), "ComponentIDValue", problem.out()));
    if (problem) Fail("ComponentIDValue: " + problem.text());
  }
}

void GigeCamera::Impl::CheckUnits() {
  if (Has("Scan3dDistanceUnit")) {
    const std::string unit = Get("Scan3dDistanceUnit");
    if (unit == "Meter") {
      metres_per_unit = 1.0;
    } else if (unit != "Millimeter") {
      Fail("Scan3dDistanceUnit is '" + unit + "', allowed are Millimeter, Meter");
    }
  }
  // Points are taken as they come; a camera that wants them scaled would be misread.
  Problem problem;
  for (const auto& [feature, wanted] :
       {std::pair("Scan3dCoordinateScale", 1.0), std::pair("Scan3dCoordinateOffset", 0.0)}) {
    if (!Has(feature)) continue;
    const double value = arv_device_get_float_feature_value(base(), feature, problem.out());
    if (problem) Fail(std::string(feature) + ": " + problem.text());
    if (value != wanted) {
      Fail(std::string(feature) + " is " + Number(value) + ", allowed is " + Number(wanted));
    }
  }
}

/// A new stream: its own port, so that no packet of an older one is taken for its own.
void GigeCamera::Impl::Start() {
  RequireTime("a stream of frames");
  Problem problem;
  stream.reset(arv_device_create_stream(base(), nullptr, nullptr, problem.out()));
  if (!stream) Fail("no stream of frames: " + problem.text());
  g_object_set(stream.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_AUTO, "frame-retention",
               kRetentionUs, nullptr);
  const gint64 payload = arv_device_get_integer_feature_value(base(), "PayloadSize", problem.out());
  if (problem) Fail("PayloadSize: " + problem.text());
  if (payload <= 0 || static_cast<std::size_t>(payload) > kMaxPayload) {
    Fail("PayloadSize is " + std::to_string(payload) + ", allowed are 1 to " +
         std::to_string(kMaxPayload));
  }
  constexpr int kBuffers = 2;  // One may come while one is read.
  for (int i = 0; i < kBuffers; ++i) {
    arv_stream_push_buffer(stream.get(),
                           arv_buffer_new_allocate(static_cast<std::size_t>(payload)));
  }
  Execute("AcquisitionStart");
}

NoFrame GigeCamera::Impl::NoRange(ArvBuffer* buffer) const {
  const guint parts = arv_buffer_get_n_parts(buffer);
  std::string text = "a frame came without a range image of Coord3D_ABC32f; it has " +
                     std::to_string(parts) + (parts == 1 ? " part" : " parts");
  for (guint i = 0; i < parts && i < 4; ++i) {
    text += (i == 0 ? ", pixel format " : ", ") +
            std::to_string(static_cast<std::uint32_t>(arv_buffer_get_part_pixel_format(buffer, i)));
  }
  return {NoFrame::Kind::kNoRange, text};
}

ReceivedFrame GigeCamera::Impl::Read(ArvBuffer* buffer) const {
  const ArvBufferStatus status = arv_buffer_get_status(buffer);
  if (status != ARV_BUFFER_STATUS_SUCCESS) {
    return NoFrame{NoFrame::Kind::kIncomplete, ToText(status)};
  }
  const auto parts = static_cast<gint>(arv_buffer_get_n_parts(buffer));
  gint part = range_id == 0 || parts < 2 ? -1 : arv_buffer_find_component(buffer, range_id);
  for (gint i = 0; i < parts && part < 0; ++i) {
    const ArvPixelFormat format = arv_buffer_get_part_pixel_format(buffer, static_cast<guint>(i));
    if (format == ARV_PIXEL_FORMAT_COORD3D_ABC_32F) part = i;
  }
  if (part < 0) return NoRange(buffer);
  const auto chosen = static_cast<guint>(part);
  if (arv_buffer_get_part_pixel_format(buffer, chosen) != ARV_PIXEL_FORMAT_COORD3D_ABC_32F) {
    return NoRange(buffer);
  }
  RangeImage image;
  image.width = arv_buffer_get_part_width(buffer, chosen);
  image.height = arv_buffer_get_part_height(buffer, chosen);
  image.data = arv_buffer_get_part_data(buffer, chosen, &image.bytes);
  image.metres_per_unit = metres_per_unit;
  auto cloud = CloudOfRange(image);
  if (const auto* problem = std::get_if<std::string>(&cloud)) {
    return NoFrame{NoFrame::Kind::kNoRange, *problem};
  }
  return std::get<OrganizedCloud>(std::move(cloud));
}

GigeCamera::GigeCamera(const std::string& host) : impl_(std::make_unique<Impl>(host)) {}
GigeCamera::~GigeCamera() = default;

const std::string& GigeCamera::name() const { return impl_->name; }
bool GigeCamera::lost() const { return impl_->lost; }

void GigeCamera::Trigger() {
  // Nobody asked for what is there already.
  while (ArvBuffer* stray = arv_stream_try_pop_buffer(impl_->stream.get())) {
    arv_stream_push_buffer(impl_->stream.get(), stray);
  }
  impl_->Execute("TriggerSoftware");
}

ReceivedFrame GigeCamera::Receive(std::chrono::milliseconds wait) {
  const auto wait_us = static_cast<guint64>(std::chrono::microseconds(wait).count());
  ArvBuffer* buffer = arv_stream_timeout_pop_buffer(impl_->stream.get(), wait_us);
  if (buffer == nullptr) return NoFrame{};
  ReceivedFrame frame = impl_->Read(buffer);
  arv_stream_push_buffer(impl_->stream.get(), buffer);
  return frame;
}

void GigeCamera::Restart() {
  impl_->began = SteadyClock::now();
  impl_->Execute("AcquisitionStop");
  impl_->stream.reset();
  impl_->Start();
}

}  // namespace tubetwin
