#pragma once

#include <cstdint>

namespace tubetwin {

/// Registers of the emulated scanner that aravis's fake camera knows nothing of; its own ones (arv:
/// arvfakecamera.h) are below 0x400.
namespace gige_registers {
/// 1: a scan is wanted. Not the fake camera's own trigger register, at which it would make a frame
/// at once; a scanner has to scan first.
inline constexpr std::uint32_t kTrigger = 0x400;
inline constexpr std::uint32_t kComponent = 0x404;         ///< Selected component.
inline constexpr std::uint32_t kComponentEnabled = 0x408;  ///< Of the range image.
inline constexpr std::uint32_t kNonce = 0x40c;             ///< Tells emulators apart.
inline constexpr std::uint32_t kRangeComponent = 4;        ///< Id of the range image.
}  // namespace gige_registers

/// The GenICam description of the emulated scanner: those features of a PhoXi, by their names in
/// the GenICam standard features, that serve one range image on software trigger.
extern const char* const kScannerGenicam;

}  // namespace tubetwin
