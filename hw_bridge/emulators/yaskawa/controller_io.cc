#include "hw_bridge/emulators/yaskawa/controller_io.h"

#include <type_traits>

namespace tubetwin {
namespace {

namespace sm = simple_message;

struct AddressRange {
  std::uint32_t first, last;  ///< Bit addresses.
  bool writable;
};
constexpr std::uint32_t kRegisters = 1000000, kLastRegister = 1000999, kLastWritable = 1000559;
constexpr AddressRange kRanges[] = {
    {10, 5127, false},      // general inputs
    {10010, 15127, true},   // general outputs
    {20010, 25127, false},  // external inputs
    {27010, 29567, true},   // network inputs
    {30010, 35127, false},  // external outputs
    {37010, 39567, false},  // network outputs
    {40010, 42567, false},  // specific inputs
    {50010, 55127, false},  // specific outputs
    {60010, 60647, true},   // interface panel
    {70010, 79997, false},  // auxiliary relays
    {80010, 85127, false},  // controller status
    {87010, 87207, false},  // pseudo inputs
    {kRegisters, kLastWritable, true},
    {kLastWritable + 1, kLastRegister, false},
};
constexpr std::uint32_t kBits = 8, kMaxGroup = 0xFF, kMaxRegister = 0xFFFF;

enum class Size { kBit, kGroup, kRegister };

/// The range of an address, as the controller looks for it: bits and groups of registers are
/// addresses like others.
const AddressRange* RangeOf(std::uint32_t address, Size size) {
  if (size != Size::kRegister && address % 10 >= kBits) return nullptr;
  for (const AddressRange& range : kRanges) {
    if (address >= range.first && address <= range.last) return &range;
  }
  return nullptr;
}

std::uint32_t Unsigned(std::int32_t value) { return static_cast<std::uint32_t>(value); }

struct Answerer {
  ControllerIo& io;

  using Result = std::optional<sm::Body>;

  template <typename Reply>
  Reply Read(std::uint32_t address, Size size) const {
    if (RangeOf(address, size) == nullptr) return Reply{0, sm::kIoReadAddress};
    if (size != Size::kGroup) return Reply{io.Word(address), 0};
    if (address % 10 != 0) return Reply{0, sm::kIoReadFailure};
    std::int32_t value = 0;
    for (std::uint32_t i = 0; i < kBits; ++i) value |= io.Word(address + i) << i;
    return Reply{value, 0};
  }
  template <typename Reply>
  Reply Write(std::uint32_t address, Size size, std::uint32_t value) const {
    const AddressRange* const range = RangeOf(address, size);
    if (range == nullptr || !range->writable) return Reply{sm::kIoWriteAddress};
    const std::uint32_t most = size == Size::kBit     ? 1
                               : size == Size::kGroup ? kMaxGroup
                                                      : kMaxRegister;
    if (value > most) return Reply{sm::kIoWriteValue};
    if (size != Size::kGroup) {
      io.SetWord(address, static_cast<std::uint16_t>(value));
      return Reply{0};
    }
    if (address % 10 != 0) return Reply{sm::kIoWriteFailure};
    for (std::uint32_t i = 0; i < kBits; ++i) {
      io.SetWord(address + i, static_cast<std::uint16_t>(value >> i & 1));
    }
    return Reply{0};
  }
  static std::uint32_t RegisterAddress(std::int32_t number) {
    const std::uint32_t address = Unsigned(number);
    return address < kRegisters ? address + kRegisters : address;
  }

  Result operator()(const sm::ReadBit& r) const {
    return Read<sm::ReadBitReply>(Unsigned(r.address), Size::kBit);
  }
  Result operator()(const sm::WriteBit& r) const {
    return Write<sm::WriteBitReply>(Unsigned(r.address), Size::kBit, Unsigned(r.value));
  }
  // Ten times an address may pass 32 bits, here as there.
  Result operator()(const sm::ReadGroup& r) const {
    return Read<sm::ReadGroupReply>(10u * Unsigned(r.address), Size::kGroup);
  }
  Result operator()(const sm::WriteGroup& r) const {
    return Write<sm::WriteGroupReply>(10u * Unsigned(r.address), Size::kGroup, Unsigned(r.value));
  }
  Result operator()(const sm::ReadRegister& r) const {
    return Read<sm::ReadRegisterReply>(RegisterAddress(r.address), Size::kRegister);
  }
  Result operator()(const sm::WriteRegister& r) const {
    return Write<sm::WriteRegisterReply>(RegisterAddress(r.address), Size::kRegister,
                                         Unsigned(r.value));
  }
  template <typename Other>
  Result operator()(const Other&) const {
    return std::nullopt;
  }
};

/// The result of a reply.
struct ResultOf {
  template <typename Reply>
  std::int32_t operator()(const Reply& reply) const {
    if constexpr (requires { reply.result == 0; }) {
      if constexpr (std::is_same_v<decltype(reply.result), std::int32_t>) return reply.result;
    }
    return 0;
  }
};

std::int32_t GroupOfOutput(int number) { return 1001 + (number - 1) / 8; }

}  // namespace

std::optional<sm::Message> ControllerIo::Answer(const sm::Body& request) {
  const std::optional<sm::Body> body = std::visit(Answerer{*this}, request);
  if (!body) return std::nullopt;
  sm::Message answer = sm::Reply(*body);
  if (std::visit(ResultOf{}, *body) != 0) answer.reply = sm::ReplyCode::kFailure;
  return answer;
}

std::uint16_t ControllerIo::Word(std::uint32_t address) const {
  if (address >= kRegisters) return Register(static_cast<int>(address - kRegisters));
  const auto found = groups_.find(static_cast<std::int32_t>(address / 10));
  return found == groups_.end() ? 0 : found->second >> (address % 10) & 1;
}

void ControllerIo::SetWord(std::uint32_t address, std::uint16_t value) {
  if (address >= kRegisters) return SetRegister(static_cast<int>(address - kRegisters), value);
  SetBit(static_cast<std::int32_t>(address), value != 0);
}

void ControllerIo::SetBit(std::int32_t address, bool on) {
  std::uint8_t& group = groups_[address / 10];
  const auto bit = static_cast<std::uint8_t>(1u << (address % 10));
  group = static_cast<std::uint8_t>(on ? group | bit : group & ~bit);
}

void ControllerIo::SetOutput(int number, bool on) {
  SetBit(10 * GroupOfOutput(number) + (number - 1) % 8, on);
}

bool ControllerIo::Output(int number) const {
  const auto found = groups_.find(GroupOfOutput(number));
  return found != groups_.end() && (found->second >> ((number - 1) % 8) & 1) == 1;
}

std::optional<std::uint8_t> ControllerIo::Group(std::int32_t address) const {
  if (RangeOf(10u * Unsigned(address), Size::kGroup) == nullptr) return std::nullopt;
  const auto found = groups_.find(address);
  return found == groups_.end() ? std::uint8_t{0} : found->second;
}

std::uint16_t ControllerIo::Register(int number) const {
  const auto found = registers_.find(number);
  return found == registers_.end() ? std::uint16_t{0} : found->second;
}

void ControllerIo::SetRegister(int number, std::uint16_t value) { registers_[number] = value; }

}  // namespace tubetwin
