#include "models/mesh/mesh.h"

#include <fstream>
#include <functional>

#include "models/base/error.h"
#include "models/base/random.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tube_mesh.h"

namespace tubetwin {
namespace {

const Mesh kTube = MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.3, 0, 0), Vector3(0.4, 0.1, 0)}, 0.01);

std::string Written(const TemporaryFolder& folder, const std::string& name,
                    const std::string& content) {
  std::ofstream(folder / name, std::ios::binary) << content;
  return folder / name;
}

void CheckRefused(const std::function<void()>& call, ErrorKind kind, const std::string& said) {
  INFO(said);
  try {
    call();
  } catch (const Error& error) {
    CHECK(static_cast<int>(error.kind()) == static_cast<int>(kind));
    CHECK_THAT(error.what(), Catch::Contains(said));
    return;
  }
  FAIL("not refused");
}

double Area(const Mesh& mesh) {
  double area = 0.0;
  for (const MeshPoint& corner : FaceCorners(mesh)) area += corner.area;
  return area;
}

TEST_CASE("STL, OBJ and PLY give the same surface with welded vertices", "[unit]") {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> files = {
      {"b.stl", BinaryStl(kTube)}, {"s.stl", "solid" + BinaryStl(kTube).substr(5)},
      {"t.STL", TextStl(kTube)},   {"o.obj", Obj(kTube)},
      {"t.ply", TextPly(kTube)},   {"b.ply", BinaryPly(kTube)}};
  for (const auto& [name, content] : files) {
    INFO(name);
    const Mesh read = ReadMesh(Written(folder, name, content));
    CHECK(read.vertices.size() == kTube.vertices.size());
    CHECK(read.faces.size() == kTube.faces.size());
    constexpr double kSixDigits = 1e-4;  // Text files of the test hold as many.
    CHECK(Area(read) == Approx(Area(kTube)).epsilon(kSixDigits));
  }
}

TEST_CASE("A file that is no mesh is refused with the reason", "[unit]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& content,
                           const std::string& said) {
    const std::string path = Written(folder, name, content);
    CheckRefused([&] { ReadMesh(path); }, ErrorKind::kBadData, said);
  };
  CheckRefused([&] { ReadMesh(folder / "none.stl"); }, ErrorKind::kMissing, "no such file");
  refused("a.step", "ISO-10303-21;", ".stl, .obj and .ply");
  refused("empty.stl", "", "is empty");
  refused("noise.ply", "no mesh at all\n", "the first line is not 'ply': no PLY file");
  refused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "holds no triangle");
  refused("endless.ply", "ply\nformat ascii 1.0\nelement vertex 3\n",
          "the file ends inside its header");
  refused("words.obj", "this is no mesh\n", "words.obj");
  refused("cut.stl", BinaryStl(kTube).substr(0, 300), "but has only 300 bytes");
  std::string huge = TextPly(kTube);
  huge.replace(huge.find("element vertex "), 17, "element vertex 4000000000");
  refused("huge.ply", huge, "count of element 'vertex' is 4000000000");
  Mesh broken = kTube;
  broken.vertices[5].y() = std::numeric_limits<double>::quiet_NaN();
  refused("nan.stl", BinaryStl(broken), "finite numbers are needed");
  refused("nan.ply", BinaryPly(broken), "finite numbers are needed");
  Mesh flat = kTube;
  for (Vector3& v : flat.vertices) v = Vector3(1, 2, 3);
  refused("point.stl", BinaryStl(flat), "points or lines");
}

TEST_CASE("Damaged files are read or refused, nothing else", "[unit]") {
  const TemporaryFolder folder;
  RandomStream stream(1, 0, "damage");
  const std::vector<std::pair<std::string, std::string>> files = {{"x.stl", BinaryStl(kTube)},
                                                                  {"x.obj", Obj(kTube)},
                                                                  {"x.ply", TextPly(kTube)},
                                                                  {"y.ply", BinaryPly(kTube)},
                                                                  {"y.stl", TextStl(kTube)}};
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    auto [name, content] = files[static_cast<std::size_t>(i) % files.size()];
    for (int k = 0; k < 1 + i % 8; ++k) {
      const std::size_t most = i % 2 == 0 ? 400 : content.size();
      content[stream.Index(static_cast<std::uint32_t>(std::min(most, content.size())))] =
          static_cast<char>(stream.Index(256));
    }
    if (i % 5 == 0) content.resize(stream.Index(static_cast<std::uint32_t>(content.size())));
    try {
      const Mesh mesh = ReadMesh(Written(folder, name, content));
      CHECK_FALSE(mesh.faces.empty());
    } catch (const Error& error) {
      CHECK(static_cast<int>(error.kind()) == static_cast<int>(ErrorKind::kBadData));
      ++refused;
    }
  }
  CHECK(refused > 30);
}

TEST_CASE("A mesh without a plausible size asks for its unit and shows each", "[unit]") {
  Mesh mesh = kTube;
  for (Vector3& v : mesh.vertices) v *= 1000.0;
  for (const char* said : {"--units", "mm: 0.407", "m: 407", "in: 10.3", "cm: 4.07"}) {
    CheckRefused([&] { ScaleToMetres(mesh, "", "tube.stl", "--units"); }, ErrorKind::kBadData,
                 said);
  }
  CheckRefused([&] { ScaleToMetres(mesh, "in", "tube.stl", "--units"); }, ErrorKind::kBadData,
               "in in");
  ScaleToMetres(mesh, "mm", "tube.stl", "--units");
  CHECK(mesh.BoxSize().x() == Approx(kTube.BoxSize().x()));
  ScaleToMetres(mesh, "", "tube.stl", "--units");  // Metres by now.
}

TEST_CASE("Pieces come apart, the largest first, wound outwards", "[unit]") {
  Mesh inside_out = kTube;
  for (auto& face : inside_out.faces) std::swap(face[0], face[1]);
  const Mesh box = MakeBoxMesh({0, 1, 0}, {0.01, 0.01, 0.01});
  const std::vector<Mesh> pieces = ConnectedPieces(Together(box, inside_out));
  REQUIRE(pieces.size() == 2);
  CHECK(pieces[0].faces.size() == kTube.faces.size());
  CHECK(pieces[1].faces.size() == 12);
  for (const MeshPoint& sample : SampleSurface(pieces[1], 200)) {
    CHECK(sample.n.dot(sample.p - Vector3(0, 1, 0)) == Approx(0.01));
  }
}

TEST_CASE("Samples are spread evenly and normals are smooth around, sharp at cuts", "[unit]") {
  const Mesh tube = MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.4, 0, 0)}, 0.01);
  int first_half = 0, ends = 0;
  for (const MeshPoint& sample : SampleSurface(tube, 10'000)) {
    first_half += sample.p.x() < 0.2;
    if (std::abs(sample.n.x()) > 0.999) {
      ++ends;
      continue;
    }
    const Vector3 radial = Vector3(0, sample.p.y(), sample.p.z()).normalized();
    CHECK(sample.n.dot(radial) > 0.999);
  }
  CHECK(first_half == Approx(5000).margin(20));
  CHECK(ends == Approx(10'000 * 0.01 / 0.41).epsilon(0.05));  // r / (r + L) of the area.
}

TEST_CASE("A closed mesh has a volume, a bore is none of it, an open one has none", "[unit]") {
  const Polyline line = {Vector3(1, 2, 3), Vector3(1.4, 2, 3)};
  TubeMeshOptions options;
  options.sides = 64;
  const double polygon = 32.0 * std::sin(2.0 * kPi / 64.0);  // Over r^2.
  const auto volume = [&] {
    return EnclosedVolume(ConnectedPieces(MakeTubeMesh(line, 0.01, options)).front());
  };
  REQUIRE(volume());
  CHECK(*volume() == Approx(polygon * 1e-4 * 0.4));
  options.bore_m = 0.008;
  REQUIRE(volume());
  CHECK(*volume() == Approx(polygon * (1e-4 - 0.64e-4) * 0.4));
  options.ends = TubeMeshOptions::Ends::kOpen;
  CHECK_FALSE(volume());
  CHECK_FALSE(EnclosedVolume(Mesh{}));
}

}  // namespace
}  // namespace tubetwin
