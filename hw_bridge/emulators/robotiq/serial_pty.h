#pragma once

#include <string>
#include <string_view>

namespace tubetwin {

/// A serial device made of a pseudo-terminal: a client opens its path as it would a cable's. Never
/// blocks; what a client does not read is lost, as on a wire.
class SerialPty {
 public:
  /// `link`: a symbolic link to the device, removed again by the destructor; empty: none. Throws
  /// Error(kDevice) naming `who` when no pseudo-terminal or link can be made; a link that is left
  /// over is replaced, anything else of that name is not.
  SerialPty(const std::string& who, const std::string& link);
  ~SerialPty();
  SerialPty(const SerialPty&) = delete;
  SerialPty& operator=(const SerialPty&) = delete;

  /// The link, or the device itself.
  const std::string& path() const { return link_.empty() ? device_ : link_; }
  std::string Read();  ///< Up to 4 KB of what has come in.
  void Write(std::string_view bytes);

 private:
  std::string device_, link_;
  int ours_ = -1;
  int theirs_ = -1;  ///< Held open, so that it lives while no client has it.
};

}  // namespace tubetwin
