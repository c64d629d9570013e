#pragma once

#include "scenes/pile.h"

// How piles are made; inside this room only (GeneratePile is the entrance).
namespace tubetwin::arrange {

/// What all arrangements start from.
struct Order {
  Part part;
  Bin bin;
  int count = 0;
  RoundPhysics physics;
};

/// The part as tube `id` of the batch has it: its own radius, length and mass.
Part SpecimenPart(const Order& order, int id);

/// A tube of the part in the shape `shape` (own frame) at X_NShape; a hose's rest shape is `shape`.
PileTube MakeTube(const Part& part, int id, const Polyline& shape, const RigidTransform& X_NShape);

/// An empty pile for `order`.
Pile EmptyPile(const Order& order);

/// One by one from just above the pile, then settled.
SettleResult Drop(const Order& order, RandomStream stream);

/// Dropped, then swept by a rod on force-limited servos, then settled.
SettleResult Stir(const Order& order, RandomStream stream);

/// Laid over and under each other by tilting, then released and settled. Escaped with a reason when
/// no such layout was found.
SettleResult Thread(const Order& order, RandomStream stream);

}  // namespace tubetwin::arrange
