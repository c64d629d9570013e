#include "models/mesh/mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "models/base/error.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr double kSmallest_m = 0.02, kLargest_m = 3.0;
/// Faces that meet at less than 65 degrees stand for one smooth surface: eight sides make a tube,
/// a cut end (90 degrees) stays an edge.
constexpr double kSmoothCosine = 0.4226;

using Faces = std::vector<std::array<int, 3>>;

const Vector3& Corner(const Mesh& mesh, const std::array<int, 3>& face, std::size_t k) {
  return mesh.vertices[static_cast<std::size_t>(face[k])];
}

/// Normal with the length of twice the area.
Vector3 FaceVector(const Mesh& mesh, const std::array<int, 3>& face) {
  return (Corner(mesh, face, 1) - Corner(mesh, face, 0))
      .cross(Corner(mesh, face, 2) - Corner(mesh, face, 0));
}

std::string BoxText(const Vector3& size, double scale) {
  char text[96];
  std::snprintf(text, sizeof text, "%.4g x %.4g x %.4g m", scale * size.x(), scale * size.y(),
                scale * size.z());
  return text;
}

/// Root of a vertex in the forest of pieces, with path halving.
int Root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    int& up = parent[static_cast<std::size_t>(i)];
    up = parent[static_cast<std::size_t>(up)];
    i = up;
  }
  return i;
}

/// Turns faces so that neighbours pass their common edge in opposite directions.
void WindAlike(Faces& faces) {
  struct Side {
    int face;
    bool forward;
  };
  std::map<std::pair<int, int>, std::vector<Side>> edges;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = faces[f][k], b = faces[f][(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].push_back({static_cast<int>(f), a < b});
    }
  }
  std::vector<std::array<std::pair<int, bool>, 3>> neighbours(faces.size());
  for (auto& list : neighbours) list.fill({-1, false});
  for (const auto& [edge, sides] : edges) {
    if (sides.size() != 2) continue;  // A rim, or more than a surface.
    for (int i = 0; i < 2; ++i) {
      auto& list = neighbours[static_cast<std::size_t>(sides[static_cast<std::size_t>(i)].face)];
      const auto free = std::find_if(list.begin(), list.end(), [](auto& n) { return n.first < 0; });
      *free = {sides[static_cast<std::size_t>(1 - i)].face, sides[0].forward == sides[1].forward};
    }
  }
  enum : char { kUnseen, kKept, kTurned };
  std::vector<char> state(faces.size(), kUnseen);
  std::vector<int> stack;
  for (std::size_t seed = 0; seed < faces.size(); ++seed) {
    if (state[seed] != kUnseen) continue;
    state[seed] = kKept;
    stack.assign(1, static_cast<int>(seed));
    while (!stack.empty()) {
      const auto f = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      for (const auto& [g, differs] : neighbours[f]) {
        if (g < 0 || state[static_cast<std::size_t>(g)] != kUnseen) continue;
        const bool turned = (state[f] == kTurned) != differs;
        state[static_cast<std::size_t>(g)] = turned ? kTurned : kKept;
        stack.push_back(g);
      }
    }
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (state[f] == kTurned) std::swap(faces[f][1], faces[f][2]);
  }
}

/// Six times the enclosed volume, seen from the middle of the vertices: negative when the normals
/// look inwards.
double SignedVolume(const Mesh& mesh) {
  Vector3 middle = Vector3::Zero();
  for (const Vector3& v : mesh.vertices) middle += v;
  middle /= static_cast<double>(mesh.vertices.size());
  double volume = 0.0;
  for (const auto& face : mesh.faces) {
    volume += (Corner(mesh, face, 0) - middle).dot(FaceVector(mesh, face));
  }
  return volume;
}

/// Unit normals at the corners of every face: of the faces around the vertex that continue the
/// face smoothly, each by its angle there.
std::vector<std::array<Vector3, 3>> CornerNormals(const Mesh& mesh) {
  struct Use {
    std::size_t face, corner;
  };
  std::vector<std::vector<Use>> uses(mesh.vertices.size());
  std::vector<Vector3> flat(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    flat[f] = FaceVector(mesh, mesh.faces[f]).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      uses[static_cast<std::size_t>(mesh.faces[f][k])].push_back({f, k});
    }
  }
  const auto angle = [&](const Use& use) {
    const auto& face = mesh.faces[use.face];
    const Vector3 p = Corner(mesh, face, use.corner);
    const Vector3 a = Corner(mesh, face, (use.corner + 1) % 3) - p;
    const Vector3 b = Corner(mesh, face, (use.corner + 2) % 3) - p;
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  std::vector<std::array<Vector3, 3>> out(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vector3 sum = Vector3::Zero();
      for (const Use& use : uses[static_cast<std::size_t>(mesh.faces[f][k])]) {
        if (flat[use.face].dot(flat[f]) > kSmoothCosine) sum += angle(use) * flat[use.face];
      }
      out[f][k] = sum.norm() > 0.0 ? sum.normalized() : flat[f];
    }
  }
  return out;
}

}  // namespace

Vector3 Mesh::BoxSize() const {
  if (vertices.empty()) return Vector3::Zero();
  Vector3 low = vertices.front(), high = low;
  for (const Vector3& v : vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return high - low;
}

void ScaleToMetres(Mesh& mesh, const std::string& units, const std::string& source,
                   const std::string& option) {
  const Vector3 size = mesh.BoxSize();
  const double scale = units.empty() ? 1.0 : MetresPer(units).value();
  const double longest = scale * size.maxCoeff();
  if (!(longest >= kSmallest_m && longest <= kLargest_m)) {
    std::vector<std::string> choices;
    for (const std::string& unit : LengthUnits()) {
      choices.push_back(unit + ": " + BoxText(size, MetresPer(unit).value()));
    }
    throw Error(ErrorKind::kBadData,
                source + ": its box is " + BoxText(size, scale) +
                    (units.empty() ? " if its numbers are metres" : " in " + units) +
                    ", allowed are 0.02 to 3 m.\nSay the file's unit with " + option + ": " +
                    Join(choices, "; "));
  }
  for (Vector3& v : mesh.vertices) v *= scale;
}

std::vector<Mesh> ConnectedPieces(const Mesh& mesh) {
  std::vector<int> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& face : mesh.faces) {
    for (std::size_t k = 1; k < 3; ++k) {
      const int a = Root(parent, face[0]), b = Root(parent, face[k]);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  std::vector<int> piece_of(mesh.vertices.size(), -1), place(mesh.vertices.size(), -1);
  std::vector<Mesh> pieces;
  for (const auto& face : mesh.faces) {
    const auto root = static_cast<std::size_t>(Root(parent, face[0]));
    if (piece_of[root] < 0) {
      piece_of[root] = static_cast<int>(pieces.size());
      pieces.emplace_back();
    }
    Mesh& piece = pieces[static_cast<std::size_t>(piece_of[root])];
    std::array<int, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      int& at = place[static_cast<std::size_t>(face[k])];
      if (at < 0) {
        at = static_cast<int>(piece.vertices.size());
        piece.vertices.push_back(Corner(mesh, face, k));
      }
      corners[k] = at;
    }
    piece.faces.push_back(corners);
  }
  for (Mesh& piece : pieces) {
    WindAlike(piece.faces);
    if (SignedVolume(piece) >= 0.0) continue;
    for (auto& face : piece.faces) std::swap(face[1], face[2]);
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const Mesh& a, const Mesh& b) {
    return a.BoxSize().norm() > b.BoxSize().norm();
  });
  return pieces;
}

std::optional<double> EnclosedVolume(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& face : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = face[k], b = face[(k + 1) % 3];
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
  }
  for (const auto& [edge, faces] : edges) {
    if (faces != 2) return std::nullopt;
  }
  if (mesh.faces.empty()) return std::nullopt;
  return SignedVolume(mesh) / 6.0;
}

std::vector<MeshPoint> SampleSurface(const Mesh& mesh, int count) {
  const auto normals = CornerNormals(mesh);
  std::vector<double> until(mesh.faces.size());
  double total = 0.0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    until[f] = total += 0.5 * FaceVector(mesh, mesh.faces[f]).norm();
  }
  std::vector<MeshPoint> out;
  if (!(total > 0.0)) return out;
  out.reserve(static_cast<std::size_t>(count));
  // Equal steps of area choose the face; an additive recurrence spreads the points within faces
  // (steps: powers of the plastic number's inverse).
  constexpr double kStepU = 0.7548776662466927, kStepV = 0.5698402909980532;
  std::size_t f = 0;
  for (int i = 0; i < count; ++i) {
    const double area = (i + 0.5) / count * total;
    while (f + 1 < until.size() && until[f] < area) ++f;
    double u = std::fmod(i * kStepU, 1.0), v = std::fmod(i * kStepV, 1.0);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const auto& face = mesh.faces[f];
    MeshPoint point;
    point.p = (1.0 - u - v) * Corner(mesh, face, 0) + u * Corner(mesh, face, 1) +
              v * Corner(mesh, face, 2);
    point.n = ((1.0 - u - v) * normals[f][0] + u * normals[f][1] + v * normals[f][2]).normalized();
    point.area = total / count;
    out.push_back(point);
  }
  return out;
}

std::vector<MeshPoint> FaceCorners(const Mesh& mesh) {
  const auto normals = CornerNormals(mesh);
  std::vector<MeshPoint> out;
  out.reserve(3 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const double area = FaceVector(mesh, mesh.faces[f]).norm() / 6.0;
    for (std::size_t k = 0; k < 3; ++k) {
      out.push_back({Corner(mesh, mesh.faces[f], k), normals[f][k], area});
    }
  }
  return out;
}

}  // namespace tubetwin
