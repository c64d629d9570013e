#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hw_bridge/cell/cell.h"
#include "hw_bridge/cell/servo_arm.h"
#include "models/base/json_fwd.h"
#include "models/base/parallel.h"
#include "models/physics.h"
#include "scenes/pile.h"
#include "twin/render/scan/scan_geometry.h"

namespace tubetwin {

struct TwinCellOptions {
  CellModel model;
  RoundPhysics physics;
  std::uint64_t seed = 1;  ///< Of noise streams.
  std::uint64_t round = 0;
  ScanSettings scan;        ///< Complete: its noise scale is the round's.
  Parallelism parallelism;  ///< For ray casting only.
};

/// The simulated cell: arm, gripper, sensor, scanner, bin, tray and tubes in one MuJoCo world at 1
/// kHz. The devices share the world and let time pass only through the cell's clock. One thread.
class TwinCell {
 public:
  TwinCell(const Pile& pile, const TwinCellOptions& options);
  ~TwinCell();
  Cell& cell();
  /// The same arm as cell().arm, for an emulated controller in place of it.
  ServoArm& servo_arm();

  /// Called after every 1/30 s of simulated time, at exactly k/30 s rounded to the step; for
  /// recordings. Must not change the world.
  void SetFrameObserver(std::function<void()> observer);

  /// Wakes sleeping tubes. What is stored is awake: a cell that goes on as its stored state would
  /// wakes them at the same moment.
  void WakeAll();
  /// All that the cell's future depends on, of a cell at rest: no trajectory runs, no scan waits.
  Json State() const;
  /// Goes on from such a state, on the same machine type bit by bit as the cell it was taken from
  /// after WakeAll. The cell must have been made from the same pile and options. Throws
  /// Error(kBadData).
  void Restore(const JsonView& state);

  /// The compiled model as XML (cell.xml).
  std::string ModelXml() const;
  /// Generalised positions of the whole world now (layout of ModelXml's model).
  std::vector<double> Qpos() const;

  struct Impl;  ///< The room's own; nobody else sees its definition.

 private:
  friend class Truth;
  friend class TwinCellProbe;  ///< Tests of the room look at the world through it.
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
