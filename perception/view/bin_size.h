#pragma once

#include <string>

#include "perception/view/bin_fit.h"

namespace tubetwin {

/// What two walls that face each other say about the size; empty when that is the bin's.
std::string WrongSize(const BinView::Walls& walls, const Bin& bin);

/// The walls of P = N without those parallel to a side of the bin that is seen in its place: that
/// size is right, and what faces it is no wall of another bin.
BinView::Walls WithoutSides(const BinView::Walls& walls, const Bin& bin);

}  // namespace tubetwin
