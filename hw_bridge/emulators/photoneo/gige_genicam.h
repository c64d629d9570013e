#pragma once

namespace tubetwin {

/// The GenICam description of the emulated scanner: those features of a PhoXi, by their names in
/// the GenICam standard features, that serve one range image on software trigger, and those that
/// Photoneo's own examples set. Addresses are those of gige_registers.h.
extern const char* const kScannerGenicam;

}  // namespace tubetwin
