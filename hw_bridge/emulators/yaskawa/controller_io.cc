#include "hw_bridge/emulators/yaskawa/controller_io.h"

#include <iterator>

namespace tubetwin {
namespace {

namespace sm = simple_message;

struct AddressRange {
  std::int32_t first, last;  ///< Bit addresses.
  bool writable;
};
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
};
constexpr std::int32_t kRegisters = 1000000, kLastRegister = 1000999, kLastWritable = 1000559;

const AddressRange* RangeOfGroup(std::int32_t group) {
  for (const AddressRange& range : kRanges) {
    if (group >= range.first / 10 && group <= range.last / 10) return &range;
  }
  return nullptr;
}

const AddressRange* RangeOfBit(std::int32_t bit) {
  if (bit < 0 || bit % 10 > 7) return nullptr;
  return RangeOfGroup(bit / 10);
}

struct Answerer {
  ControllerIo& io;
  std::map<std::int32_t, std::uint8_t>& groups;

  using Result = std::optional<sm::Body>;

  Result operator()(const sm::ReadBit& r) const {
    if (RangeOfBit(r.address) == nullptr) return sm::ReadBitReply{0, sm::kIoReadAddress};
    return sm::ReadBitReply{groups[r.address / 10] >> (r.address % 10) & 1, 0};
  }
  Result operator()(const sm::WriteBit& r) const {
    const AddressRange* const range = RangeOfBit(r.address);
    if (range == nullptr || !range->writable) return sm::WriteBitReply{sm::kIoWriteAddress};
    if (r.value != 0 && r.value != 1) return sm::WriteBitReply{sm::kIoWriteValue};
    std::uint8_t& group = groups[r.address / 10];
    const auto bit = static_cast<std::uint8_t>(1u << (r.address % 10));
    group = static_cast<std::uint8_t>(r.value == 1 ? group | bit : group & ~bit);
    return sm::WriteBitReply{0};
  }
  Result operator()(const sm::ReadGroup& r) const {
    if (RangeOfGroup(r.address) == nullptr) return sm::ReadGroupReply{0, sm::kIoReadAddress};
    return sm::ReadGroupReply{groups[r.address], 0};
  }
  Result operator()(const sm::WriteGroup& r) const {
    const AddressRange* const range = RangeOfGroup(r.address);
    if (range == nullptr || !range->writable) return sm::WriteGroupReply{sm::kIoWriteAddress};
    if (r.value < 0 || r.value > 255) return sm::WriteGroupReply{sm::kIoWriteValue};
    groups[r.address] = static_cast<std::uint8_t>(r.value);
    return sm::WriteGroupReply{0};
  }
  Result operator()(const sm::ReadRegister& r) const {
    if (r.address < kRegisters || r.address > kLastRegister) {
      return sm::ReadRegisterReply{0, sm::kIoReadAddress};
    }
    return sm::ReadRegisterReply{io.Register(r.address - kRegisters), 0};
  }
  Result operator()(const sm::WriteRegister& r) const {
    if (r.address < kRegisters || r.address > kLastWritable) {
      return sm::WriteRegisterReply{sm::kIoWriteAddress};
    }
    if (r.value < 0 || r.value > 65535) return sm::WriteRegisterReply{sm::kIoWriteValue};
    io.SetRegister(r.address - kRegisters, static_cast<std::uint16_t>(r.value));
    return sm::WriteRegisterReply{0};
  }
  template <typename Other>
  Result operator()(const Other&) const {
    return std::nullopt;
  }
};

std::int32_t GroupOfOutput(int number) { return 1001 + (number - 1) / 8; }

}  // namespace

std::optional<sm::Body> ControllerIo::Answer(const sm::Body& request) {
  return std::visit(Answerer{*this, groups_}, request);
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
  if (RangeOfGroup(address) == nullptr) return std::nullopt;
  const auto found = groups_.find(address);
  return found == groups_.end() ? std::uint8_t{0} : found->second;
}

std::uint16_t ControllerIo::Register(int number) const {
  const auto found = registers_.find(number);
  return found == registers_.end() ? std::uint16_t{0} : found->second;
}

void ControllerIo::SetRegister(int number, std::uint16_t value) { registers_[number] = value; }

}  // namespace tubetwin
