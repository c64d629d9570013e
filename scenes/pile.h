#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "models/base/polyline.h"
#include "models/bin.h"
#include "models/part.h"
#include "models/physics.h"

namespace tubetwin {

/// One tube of a pile. Frame N. The material is the union of capsules from node to node (round
/// ends reach one radius beyond the first and last node), and the tube's length is the
/// centerline's, node to node, as in the public set. A hose's centerline has one node per link end.
struct PileTube {
  int id = 0;
  Polyline centerline_N;
  double radius_m = 0.0;
  double mass_kg = 0.0;
  std::optional<Polyline> rest_centerline_N;  ///< Shape without load (any pose); hoses only.
};

struct Pile {
  Bin bin;
  Part part;
  std::vector<PileTube> tubes;
  std::uint64_t seed = 0;
  bool settled = false;
};

/// Reads pile.json, CSV (ParsePileCsv) or the public set's tube_configurations text, told
/// apart by content. `part` and `bin_size_m` replace what the file says (CSV and text: part
/// `leao2022` and bin 0.80 x 0.60 x 0.20 m unless given); where a part replaces radii or masses
/// that the file says, `tell` gets a sentence about it. A tube's own length wins over the part's.
/// Throws Error(kMissing), Error(kBadData) naming file, line or field, value and what is allowed:
/// no tubes, NaN, fewer than two nodes, a tube longer than the bin's diagonal (with its walls), one
/// that lies outside of the bin or runs through its floor or a wall, and more.
struct PileOverrides {
  std::optional<std::string> part;
  std::optional<std::array<double, 3>> bin_size_m;
  std::optional<double> unit_m;  ///< Of the lengths in CSV and text; else metres.
  std::function<void(const std::string&)> tell;
};
Pile LoadPile(const std::string& path, const PileOverrides& overrides = {});
/// Content of a pile.json.
Json ToJson(const Pile& pile);
void SavePile(const Pile& pile, const std::string& path);
/// Throws Error(kBadData) as LoadPile does; `source` names the pile in the message.
void ValidatePile(const Pile& pile, const std::string& source);

/// Throws Error(kBadData) naming the first tube that is not in the bin, and how far from it: its
/// middle outside of the walls, or its axis in or under the floor or within a wall. Tubes that lean
/// over a wall or hang above the bin are in it. Part of LoadPile; to be asked again where the bin
/// changes.
void RequireInBin(const Pile& pile, const std::string& source);

/// escaped: a tube lies outside the bin or hangs over a wall with its centre of mass outside.
enum class SettleStatus { kSettled, kTimeout, kEscaped, kDiverged };
const char* ToString(SettleStatus status);
struct SettleResult {
  SettleStatus status = SettleStatus::kSettled;
  std::string reason;
  Pile pile;  ///< As far as it got.
  double simulated_s = 0.0;
};

/// Simulates until all is at rest (or 20 s of simulated time). Overlapping tubes of the input are
/// first pushed apart gently.
SettleResult SettlePile(const Pile& pile, const RoundPhysics& physics);

/// "dropped": one by one from above the pile. "stirred": the settled pile is swept by a virtual
/// rod, then settles again. "threaded": laid alternately over and under others without gravity,
/// then released. Same arguments, same pile. A pile of which a
/// tube leaves the bin is drawn again from the next sub-stream, at most 20 times. So is, at most 12
/// times, one with a tube over a wall and a threaded one with a free tube; the best is returned.
/// Throws Error(kUsage) for an unknown arrangement or a count outside 1 to 40, Error(kBadData) for
/// a part longer than the bin's diagonal.
SettleResult GeneratePile(const Part& part, const Bin& bin, int count,
                          const std::string& arrangement, std::uint64_t seed,
                          const RoundPhysics& physics);

/// A random shape of the part, centred at the origin, in its own frame; hoses have links + 1 nodes.
Polyline DrawShape(const Part& part, RandomStream& stream);

}  // namespace tubetwin
