#pragma once

#include <string>

#include "hw_bridge/recording/cell_event.h"
#include "models/base/random.h"

namespace tubetwin::test {

/// All bits of an event, invalid points of clouds excepted; told by nothing but the event.
std::string Bits(const CellEvent& event);

/// Random event of any kind, as a device or a pipeline could make it, or more extreme.
CellEvent RandomEvent(RandomStream& stream);

/// A cloud as a scanner gives it (`camera`: points on straight rays), or with any numbers.
OrganizedCloud RandomCloud(RandomStream& stream, int width, int height, bool camera);

/// Bits of everything in a cloud but the numbers of invalid points.
std::string Bits(const OrganizedCloud& cloud);

}  // namespace tubetwin::test
