#pragma once

#include <string>

namespace tubetwin {

/// The GenICam description of the emulated scanner: those features of a PhoXi, by their names in
/// the GenICam standard features, that serve its frames on software trigger or without one, and
/// those that Photoneo's own examples set. Addresses are those of gige_registers.h.
std::string ScannerGenicam();

}  // namespace tubetwin
