#include "tests/support/tube_mesh.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <utility>

namespace tubetwin {
namespace {

struct Ring {
  Vector3 centre, tangent;
  Vector3 u, v;  ///< Directions of the ellipse, v longer than one where a corner is mitred.
};

std::vector<Ring> RingsOf(const Polyline& line) {
  std::vector<Ring> rings;
  Vector3 u = (line[1] - line[0]).unitOrthogonal();
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vector3 in = (i == 0 ? line[1] - line[0] : line[i] - line[i - 1]).normalized();
    const Vector3 out = (i + 1 == line.size() ? in : Vector3(line[i + 1] - line[i])).normalized();
    const Vector3 t = (in + out).normalized();
    // Carry the direction over along `in`, then stretch it onto the mitre's plane.
    u = (u - u.dot(in) * in).normalized();
    const Vector3 v = in.cross(u);
    const auto on_plane = [&](const Vector3& d) { return Vector3(d - d.dot(t) / in.dot(t) * in); };
    rings.push_back({line[i], t, on_plane(u), on_plane(v)});
    u = (on_plane(u) - on_plane(u).dot(out) * out).normalized();
  }
  return rings;
}

void AddWall(Mesh& mesh, const std::vector<Ring>& rings, const std::vector<double>& radii,
             int sides, bool outwards) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (int k = 0; k < sides; ++k) {
      const double a = 2.0 * kPi * k / sides;
      mesh.vertices.push_back(rings[i].centre +
                              radii[i] * (std::cos(a) * rings[i].u + std::sin(a) * rings[i].v));
    }
  }
  for (int i = 0; i + 1 < static_cast<int>(rings.size()); ++i) {
    for (int k = 0; k < sides; ++k) {
      const int a = first + i * sides + k, b = first + i * sides + (k + 1) % sides;
      const int c = a + sides, d = b + sides;
      if (outwards) {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({a, d, c});
      } else {
        mesh.faces.push_back({a, d, b});
        mesh.faces.push_back({a, c, d});
      }
    }
  }
}

/// Puts the rings of a half sphere before the first ring and after the last.
void AddRoundEnds(std::vector<Ring>& rings, std::vector<double>& radii) {
  constexpr int kSteps = 16;
  const Ring first = rings.front(), last = rings.back();
  const double r_first = radii.front(), r_last = radii.back();
  for (int i = 1; i <= kSteps; ++i) {
    const double a = 0.5 * kPi * i / kSteps;
    Ring before = first, after = last;
    before.centre -= r_first * std::sin(a) * first.tangent;
    after.centre += r_last * std::sin(a) * last.tangent;
    rings.insert(rings.begin(), before);
    radii.insert(radii.begin(), r_first * std::cos(a));
    rings.push_back(after);
    radii.push_back(r_last * std::cos(a));
  }
}

void Append(std::string& out, const void* data, std::size_t size) {
  out.append(static_cast<const char*>(data), size);
}

void AppendFloats(std::string& out, const Vector3& p) {
  for (int k = 0; k < 3; ++k) {
    const auto value = static_cast<float>(p[k]);
    Append(out, &value, sizeof value);
  }
}

std::string PlyHead(const Mesh& mesh, const std::string& format) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(mesh.faces.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace

Mesh MakeTubeMesh(const Polyline& line, double radius_m, const TubeMeshOptions& options) {
  Mesh mesh;
  std::vector<Ring> rings = RingsOf(line);
  std::vector<double> radii(rings.size(), radius_m);
  if (!options.radii_m.empty()) radii = options.radii_m;
  if (options.end_radius_m > 0.0) {
    const std::vector<double> s = ArcLengths(line);
    for (std::size_t i = 0; i < radii.size(); ++i) {
      radii[i] += (options.end_radius_m - radius_m) * s[i] / s.back();
    }
  }
  if (options.ends == TubeMeshOptions::Ends::kRound) AddRoundEnds(rings, radii);
  const int sides = options.sides, last = sides * (static_cast<int>(rings.size()) - 1);
  AddWall(mesh, rings, radii, sides, true);
  if (options.bore_m > 0.0) {
    const int inner = static_cast<int>(mesh.vertices.size());
    AddWall(mesh, rings, std::vector<double>(rings.size(), options.bore_m), sides, false);
    if (options.ends == TubeMeshOptions::Ends::kOpen) return mesh;
    for (int k = 0; k < sides; ++k) {
      const int n = (k + 1) % sides;
      mesh.faces.push_back({k, inner + k, inner + n});
      mesh.faces.push_back({k, inner + n, n});
      mesh.faces.push_back({last + k, last + n, inner + last + n});
      mesh.faces.push_back({last + k, inner + last + n, inner + last + k});
    }
  } else if (options.ends == TubeMeshOptions::Ends::kFlat) {
    const int centres = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(line.front());
    mesh.vertices.push_back(line.back());
    for (int k = 0; k < sides; ++k) {
      const int n = (k + 1) % sides;
      mesh.faces.push_back({centres, n, k});
      mesh.faces.push_back({centres + 1, last + k, last + n});
    }
  }
  return mesh;
}

Mesh MakeSphereMesh(const Vector3& centre, double radius_m) {
  TubeMeshOptions round;
  round.ends = TubeMeshOptions::Ends::kRound;
  const Vector3 hardly(0.0, 0.0, 1e-4 * radius_m);
  return MakeTubeMesh({centre - hardly, centre + hardly}, radius_m, round);
}

Mesh MakeBoxMesh(const Vector3& centre, const Vector3& half_m) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vector3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    mesh.vertices.push_back(centre + sign.cwiseProduct(half_m));
  }
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Mesh MakeBinMesh(const Vector3& size_m, double wall_m, double lean_m) {
  Mesh mesh;
  const auto add_ring = [&](double x, double y, double z) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (const auto& [sx, sy] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      mesh.vertices.push_back({sx * x, sy * y, z});
    }
    return first;
  };
  const auto add_band = [&](int low, int high) {
    for (int k = 0; k < 4; ++k) {
      const int n = (k + 1) % 4;
      mesh.faces.push_back({low + k, high + k, high + n});
      mesh.faces.push_back({low + k, high + n, low + n});
    }
  };
  const double x = 0.5 * size_m.x(), y = 0.5 * size_m.y(), z = size_m.z();
  const int floor = add_ring(x, y, 0.0), rim = add_ring(x + lean_m, y + lean_m, z);
  mesh.faces = {{floor, floor + 1, floor + 2}, {floor, floor + 2, floor + 3}};
  add_band(floor, rim);
  if (wall_m <= 0.0) return mesh;
  const int outer_rim = add_ring(x + lean_m + wall_m, y + lean_m + wall_m, z);
  const int foot = add_ring(x + wall_m, y + wall_m, -wall_m);
  add_band(rim, outer_rim);
  add_band(outer_rim, foot);
  mesh.faces.push_back({foot, foot + 2, foot + 1});
  mesh.faces.push_back({foot, foot + 3, foot + 2});
  return mesh;
}

Mesh Together(const Mesh& a, const Mesh& b) {
  Mesh out = a;
  const int first = static_cast<int>(a.vertices.size());
  out.vertices.insert(out.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& face : b.faces) {
    out.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  }
  return out;
}

std::string BinaryStl(const Mesh& mesh, double scale) {
  std::string out(80, ' ');
  const auto count = static_cast<std::uint32_t>(mesh.faces.size());
  Append(out, &count, sizeof count);
  for (const auto& face : mesh.faces) {
    AppendFloats(out, Vector3::Zero());
    for (const int i : face) AppendFloats(out, scale * mesh.vertices[static_cast<std::size_t>(i)]);
    out.append(2, '\0');
  }
  return out;
}

std::string TextStl(const Mesh& mesh, double scale) {
  std::ostringstream out;
  out << "solid tube\n";
  for (const auto& face : mesh.faces) {
    out << " facet normal 0 0 0\n  outer loop\n";
    for (const int i : face) {
      out << "   vertex " << (scale * mesh.vertices[static_cast<std::size_t>(i)]).transpose()
          << "\n";
    }
    out << "  endloop\n endfacet\n";
  }
  out << "endsolid tube\n";
  return out.str();
}

std::string Obj(const Mesh& mesh, double scale) {
  std::ostringstream out;
  out << "o tube\n";
  for (const Vector3& v : mesh.vertices) out << "v " << (scale * v).transpose() << "\n";
  for (const auto& face : mesh.faces) {
    out << "f " << face[0] + 1 << " " << face[1] + 1 << " " << face[2] + 1 << "\n";
  }
  return out.str();
}

std::string TextPly(const Mesh& mesh, double scale) {
  std::ostringstream out;
  out << PlyHead(mesh, "ascii");
  for (const Vector3& v : mesh.vertices) out << (scale * v).transpose() << "\n";
  for (const auto& face : mesh.faces) {
    out << "3 " << face[0] << " " << face[1] << " " << face[2] << "\n";
  }
  return out.str();
}

std::string BinaryPly(const Mesh& mesh, double scale) {
  std::string out = PlyHead(mesh, "binary_little_endian");
  for (const Vector3& v : mesh.vertices) AppendFloats(out, scale * v);
  for (const auto& face : mesh.faces) {
    out += '\3';
    for (const int i : face) {
      const auto index = static_cast<std::int32_t>(i);
      Append(out, &index, sizeof index);
    }
  }
  return out;
}

}  // namespace tubetwin
