#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hw_bridge/cell/devices.h"
#include "models/base/config/config.h"
#include "models/base/error.h"
#include "models/base/json_fwd.h"
#include "models/cell_model.h"

namespace tubetwin {

/// What a driver gets when it connects, beside its own configuration.
struct DriverContext {
  const CellModel& model;  ///< Must outlive the device.
  const CellClock& clock;  ///< Must outlive the device; tells Now() to any thread.
  double rate = 1.0;       ///< Cell time per wall time, of the whole cell.
  /// False: the device is only read. No byte goes to an arm's motion port, fingers stay as they
  /// are.
  bool may_move = false;
  /// For scanners: X_NS as the pipeline believes it now. Asked for on the pick cycle's thread.
  std::function<RigidTransform()> believed_X_NS = {};
  /// A person's word for a step that could drop what the cell holds, asked with what it is: false,
  /// and the device is not connected. Empty: nobody is there.
  std::function<bool(const std::string& what)> confirm = {};
};

/// One way to reach a driver's device.
struct DriverLink {
  std::string name;  ///< What the cell file's key `driver` says: "modbus_tcp".
  std::string fix;   ///< What a person checks when the device does not answer.
  /// What is known once a device is connected that has no state to read (a scanner).
  std::string reached;
};

/// One thing that a device's own supervision tells.
struct DeviceFinding {
  std::string what;  ///< "arm mode".
  std::string told;  ///< "PLAY, REMOTE".
  std::string fix;   ///< What a person does about it; empty: it is fine.
};

/// A kind of device that can serve a role of the cell (`Device`: Arm, Gripper, ForceTorqueSensor or
/// Scanner): its keys in a cell file and how it is connected. Each object holds the values of its
/// keys. How to write one: README.md beside this file.
template <class Device>
class DeviceDriver {
 public:
  virtual ~DeviceDriver() = default;
  virtual std::unique_ptr<DeviceDriver> Clone() const = 0;

  /// At least one; their names differ from those of all other drivers of the role.
  virtual std::vector<DriverLink> Links() const = 0;
  /// "an ATI Net F/T box", for the documentation of the key `driver`.
  virtual std::string Summary() const = 0;
  /// The driver's keys, in the role's table: "host" is read from [cell.wrist] host. A key that
  /// another driver of the role has already goes into a section of the driver's own.
  virtual void Visit(ConfigVisitor& v) = 0;
  /// Throws Error(kConfig) for what shall be refused before any device of the cell is connected.
  virtual void ValidateOrThrow(const std::string& /*link*/) const {}
  /// Where the device is looked for, for messages; may be empty.
  virtual std::string Address() const { return {}; }
  /// What only one program at a time may use, as "192.168.1.1:49152"; empty: nothing of the kind.
  virtual std::string Owned(const std::string& /*link*/) const { return Address(); }
  /// The device, ready for use. Throws Error(kConfig), and Error(kDevice) naming device, place and
  /// what was awaited, within 10 s.
  virtual std::unique_ptr<Device> Connect(const std::string& link,
                                          const DriverContext& context) const = 0;
  /// What else the device's controller tells of itself, by other ways than the one that `device`
  /// (made by Connect) uses; moves and changes nothing. Does not throw: what cannot be asked is a
  /// finding.
  virtual std::vector<DeviceFinding> Examine(const Device& /*device*/,
                                             const DriverContext& /*context*/) const {
    return {};
  }
  /// Makes `counts` an object that tells what came over the link so far and what was lost. `device`
  /// came from Connect of a driver of this role; a device of another kind, or one without anything
  /// to tell, leaves `counts` as it is.
  virtual void CountLink(const Device& /*device*/, Json& /*counts*/) const {}
};

/// The drivers that one role can choose from, each with its configuration. A value: copies share
/// nothing.
template <class Device>
class DriverList {
 public:
  DriverList() = default;
  DriverList(const DriverList& other) {
    for (const auto& driver : other.drivers_) drivers_.push_back(driver->Clone());
  }
  DriverList(DriverList&&) noexcept = default;
  DriverList& operator=(DriverList other) noexcept {
    drivers_.swap(other.drivers_);
    return *this;
  }
  ~DriverList() = default;

  template <class Driver>
  void Add() {
    drivers_.push_back(std::make_unique<Driver>());
  }

  /// Names of all links, in the order of registration.
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& driver : drivers_) {
      for (const DriverLink& link : driver->Links()) names.push_back(link.name);
    }
    return names;
  }
  /// "a Robotiq 2F-85 by serial line or network, ...": what there is.
  std::string Summary() const {
    std::string all;
    for (const auto& driver : drivers_) all += (all.empty() ? "" : ", ") + driver->Summary();
    return all;
  }
  void Visit(ConfigVisitor& v) {
    for (const auto& driver : drivers_) driver->Visit(v);
  }

  /// The driver with a link of that name. Precondition: one of Names().
  const DeviceDriver<Device>& Of(const std::string& link) const {
    for (const auto& driver : drivers_) {
      for (const DriverLink& own : driver->Links()) {
        if (own.name == link) return *driver;
      }
    }
    throw LogicError("no driver is registered under the name '" + link + "'");
  }
  /// The driver of that type, for whoever knows it (an emulation of its device). Precondition: it
  /// was added.
  template <class Driver>
  const Driver& Get() const {
    for (const auto& driver : drivers_) {
      if (const auto* found = dynamic_cast<const Driver*>(driver.get())) return *found;
    }
    throw LogicError("no driver of that type is registered");
  }
  template <class Driver>
  Driver& Get() {
    return const_cast<Driver&>(std::as_const(*this).template Get<Driver>());
  }

 private:
  std::vector<std::unique_ptr<DeviceDriver<Device>>> drivers_;
};

/// The drivers of all roles.
struct DeviceDrivers {
  DriverList<Arm> arm;
  DriverList<Gripper> gripper;
  DriverList<ForceTorqueSensor> wrist;
  DriverList<Scanner> scanner;
};

}  // namespace tubetwin
