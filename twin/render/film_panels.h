#pragma once

#include "twin/render/gl/scene_renderer.h"
#include "twin/render/recording.h"

namespace tubetwin {

/// Colour of a class of tubes (0 free, 1 weak, 2 strong) and of the chosen one.
Colour ClassColour(int tube_class);
inline constexpr Colour kTargetColour = {0.10f, 0.62f, 1.00f};

/// Draws caption, clock, legend and the trace of the tared load over the last ten seconds.
/// `frame` is an index of the recording.
void DrawPanels(const Recording& recording, int frame, Image& image);

}  // namespace tubetwin
