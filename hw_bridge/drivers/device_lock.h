#pragma once

#include <string>

namespace tubetwin {

/// Keeps a device to one program of this machine: while an object of this class lives, no other
/// process (of the same network namespace) can make one for the same device. It ends with the
/// process, however that ends. Devices have no such thing themselves: a second client takes a force
/// sensor's stream and commands a gripper's fingers.
class DeviceLock {
 public:
  /// `device`: role and address, "wrist 192.168.1.1:49152". Throws Error(kInterrupted, exit 75)
  /// naming the device and who holds it; Error(kInternal) when the system has no sockets.
  explicit DeviceLock(const std::string& device);
  ~DeviceLock();
  DeviceLock(DeviceLock&& other) noexcept;
  DeviceLock& operator=(DeviceLock&&) = delete;

  /// Who holds the device: "process 1234 (tubetwin run ...)"; empty: nobody.
  static std::string HolderOf(const std::string& device);

 private:
  int socket_ = -1;
};

}  // namespace tubetwin
