// Variables, registers and I/O bytes of the emulated High-Speed Ethernet Server.

#include <algorithm>

#include "hw_bridge/codecs/little_endian.h"
#include "hw_bridge/emulators/yaskawa/hses_responder.h"

namespace tubetwin {
namespace {

using hses::Answer;
using hses::Request;

constexpr std::uint32_t kVariables = 100;  ///< Of each kind, the controller's default.
constexpr std::uint32_t kRegisterCount = 1000, kWritableRegisters = 560;
constexpr std::uint32_t kFirstNetworkInput = 2701, kLastNetworkInput = 2956;
constexpr std::uint32_t kCountSize = 4;

/// Some clients write what is shorter in a slot of 4 bytes, filled up by its sign.
std::string WithoutFill(const std::string& data, std::size_t size) {
  constexpr std::size_t kSlot = 4;
  if (data.size() != kSlot || (size != 1 && size != 2)) return data;
  const bool empty = data.find_first_not_of('\0', size) == std::string::npos;
  const bool negative = size == 2 && (Le16At(data, 0) & 0x8000) != 0;
  const bool sign = negative && data.find_first_not_of('\xff', size) == std::string::npos;
  return empty || sign ? data.substr(0, size) : data;
}

/// Sizes of the attributes of an element, by kind from kIoByte on.
std::vector<std::size_t> AttributeSizes(std::uint16_t command) {
  switch (command) {
    case hses::kIoByte:
    case hses::kVariableB:
      return {1};
    case hses::kRegister:
    case hses::kVariableI:
      return {2};
    case hses::kVariableS:
      return {16};
    case hses::kVariableS32:
      return {32};
    case hses::kVariableP:
      return std::vector<std::size_t>(13, 4);
    case hses::kVariableBp:
    case hses::kVariableEx:
      return std::vector<std::size_t>(9, 4);
    default:
      return {4};
  }
}

std::size_t SizeOf(std::uint16_t command) {
  std::size_t size = 0;
  for (const std::size_t attribute : AttributeSizes(command)) size += attribute;
  return size;
}

}  // namespace

std::optional<std::string> HsesResponder::Element(std::uint16_t command,
                                                  std::uint32_t number) const {
  std::string bytes;
  if (command == hses::kIoByte) {
    const auto group = controller_.io().Group(static_cast<std::int32_t>(number));
    if (!group) return std::nullopt;
    PutLe8(bytes, *group);
    return bytes;
  }
  if (command == hses::kRegister) {
    if (number >= kRegisterCount) return std::nullopt;
    PutLe16(bytes, controller_.io().Register(static_cast<int>(number)));
    return bytes;
  }
  if (number >= kVariables) return std::nullopt;
  if (command == hses::kVariableS) {  // The beginning of the same text.
    return Element(hses::kVariableS32, number)->substr(0, SizeOf(command));
  }
  const auto found = variables_.find({command, number});
  return found != variables_.end() ? found->second : std::string(SizeOf(command), '\0');
}

std::uint16_t HsesResponder::Write(std::uint16_t command, std::uint32_t number,
                                   const std::string& bytes) {
  if (command == hses::kIoByte) {
    if (number < kFirstNetworkInput || number > kLastNetworkInput) return hses::kNoInstance;
    for (std::uint32_t i = 0; i < 8; ++i) {
      controller_.io().SetWord(10 * number + i, Le8At(bytes, 0) >> i & 1);
    }
  } else if (command == hses::kRegister) {
    if (number >= kWritableRegisters) return hses::kNoInstance;
    controller_.io().SetRegister(static_cast<int>(number), Le16At(bytes, 0));
  } else {
    if (number >= kVariables) return hses::kNoInstance;
    if (command == hses::kVariableS) {
      std::string text = bytes;
      text.resize(SizeOf(hses::kVariableS32));
      variables_[{hses::kVariableS32, number}] = text;
      return 0;
    }
    variables_[{command, number}] = bytes;
  }
  return 0;
}

void HsesResponder::Variable(const Request& request, Answer& answer) {
  const std::vector<std::size_t> sizes = AttributeSizes(request.command);
  const auto read = SliceOf(request, hses::kGetAll, hses::kGetOne, sizes);
  const auto write = SliceOf(request, hses::kSetAll, hses::kSetOne, sizes);
  if (!read && !write) return RefuseHses(answer, hses::kNoAttribute);
  std::optional<std::string> whole = Element(request.command, request.instance);
  if (!whole) return RefuseHses(answer, hses::kNoInstance);
  if (read) {
    answer.data = whole->substr(read->at, read->size);
    return;
  }
  const std::string data = WithoutFill(request.data, write->size);
  if (data.size() != write->size) return RefuseHses(answer, hses::kDataSize);
  if (!controller_.remote()) return RefuseHses(answer, hses::kNotRemote);
  whole->replace(write->at, write->size, data);
  const std::uint16_t why = Write(request.command, request.instance, *whole);
  if (why != 0) RefuseHses(answer, why);
}

void HsesResponder::Plural(const Request& request, Answer& answer) {
  const auto command =
      request.command == hses::kPluralS32
          ? hses::kVariableS32
          : static_cast<std::uint16_t>(hses::kIoByte + (request.command - hses::kPluralIo));
  const bool write = request.service == hses::kWritePlural;
  if ((!write && request.service != hses::kReadPlural) || request.attribute != 0) {
    return RefuseHses(answer, hses::kNoAttribute);
  }
  if (request.data.size() < kCountSize) return RefuseHses(answer, hses::kDataSize);
  const std::uint32_t count = Le32At(request.data, 0);
  const std::size_t size = SizeOf(command);
  // Single bytes come in pairs.
  const bool odd = size == 1 && count % 2 != 0;
  if (count == 0 || odd || count > (hses::kMaxData - kCountSize) / size) {
    return RefuseHses(answer, hses::kOutOfRange);
  }
  if (request.data.size() != kCountSize + (write ? count * size : 0)) {
    return RefuseHses(answer, hses::kDataSize);
  }
  if (write && !controller_.remote()) return RefuseHses(answer, hses::kNotRemote);
  std::string all;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto element = Element(command, request.instance + i);
    if (!element) return RefuseHses(answer, hses::kNoInstance);
    all += *element;
  }
  if (!write) {
    answer.data = hses::Word(count) + all;
    return;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint16_t why =
        Write(command, request.instance + i, request.data.substr(kCountSize + i * size, size));
    if (why != 0) return RefuseHses(answer, why);
  }
}

}  // namespace tubetwin
