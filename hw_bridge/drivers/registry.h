#pragma once

#include "hw_bridge/drivers/device_driver.h"

namespace tubetwin {

/// Every driver of this program, with the defaults of its keys. A program of your own adds to it:
/// `drivers.wrist.Add<MyDriver>()`.
DeviceDrivers BuiltInDrivers();

}  // namespace tubetwin
