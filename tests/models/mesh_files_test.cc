// Meshes as other programs write them: what nobody needs stops nothing.

#include <algorithm>
#include <cstring>
#include <fstream>

#include "models/base/error.h"
#include "models/mesh/mesh.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tube_mesh.h"

namespace tubetwin {
namespace {

const Mesh kPipe = MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.3, 0, 0), Vector3(0.4, 0.1, 0)}, 0.01);

Mesh Read(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  std::ofstream(folder / name, std::ios::binary) << content;
  return ReadMesh(folder / name);
}

void CheckPipe(const std::string& name, const std::string& content) {
  INFO(name << "\n" << content.substr(0, 300));
  const Mesh read = Read(name, content);
  CHECK(read.vertices.size() == kPipe.vertices.size());
  CHECK(read.faces.size() == kPipe.faces.size());
  CHECK(read.BoxSize().isApprox(kPipe.BoxSize(), 1e-5));  // Text of the test has six digits.
}

void CheckBad(const std::string& name, const std::string& content, const std::string& said) {
  INFO(name << "\n" << content.substr(0, 300));
  try {
    Read(name, content);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kBadData);
    CHECK_THAT(error.what(), Catch::Contains(said) && Catch::Contains(name));
    return;
  }
  FAIL("not refused");
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string Upper(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

TEST_CASE("Text STL is read whatever stands before and around its facets", "[unit]") {
  const std::string text = TextStl(kPipe);
  REQUIRE(text.starts_with("solid"));
  CheckPipe("a.stl", " \n\t" + text);
  CheckPipe("a.stl", "\xef\xbb\xbf" + text);
  CheckPipe("a.stl", Upper(text));
  CheckPipe("a.stl", "SOLID" + text.substr(5));
  CheckPipe("a.stl", Replaced(text, "\n", "\r\n"));
  CheckPipe("a.stl", Replaced(text, "\n", "\r"));
  CheckPipe("a.stl", "# exported\n" + text + "\n\nend of file\x1a");
  CheckPipe("a.stl", "solid vertex 1 2 3 \xe4\x01\n" + text.substr(text.find('\n') + 1));
  CheckPipe("a.stl", Replaced(text, "facet normal", "facet normal 1.#QNAN -nan(ind) x"));
  const std::string body = text.substr(text.find('\n'));
  CheckPipe("a.stl", "solid all in one line" + Replaced(body, "\n", " "));
  // Two solids in one file.
  const std::size_t middle = text.find("facet", text.size() / 2) - 1;
  const std::size_t cut = text.rfind("endfacet", middle) + 8;
  CheckPipe("a.stl", text.substr(0, cut) + "\nendsolid one\nsolid two\n" + text.substr(cut));
}

TEST_CASE("Binary STL is told by its bytes, not by its first word", "[unit]") {
  const std::string binary = BinaryStl(kPipe);
  for (const char* head : {"solid", "SOLID x", " solid", "ply\n", "\x1f\x8b", "{\"a\": 1}"}) {
    std::string named = binary;
    named.replace(0, std::strlen(head), head);
    CheckPipe("a.stl", named);
    CheckPipe("a.stl", named + "bytes behind");
  }
  CheckPipe("a.stl", binary + std::string(5000, '\0'));
  std::string colours = binary;  // The two bytes behind each triangle, and its normal.
  for (std::size_t at = 84; at < colours.size(); at += 50) {
    colours.replace(at, 12, std::string(12, '\xff'));
    colours.replace(at + 48, 2, "\xff\x7f");
  }
  CheckPipe("a.stl", colours);
}

TEST_CASE("STL that is cut off or no mesh is refused with the reason", "[unit]") {
  const std::string text = TextStl(kPipe), binary = BinaryStl(kPipe);
  CheckBad("a.stl", binary.substr(0, binary.size() - 1), "the file is cut off or no mesh");
  CheckBad("a.stl", "solid" + binary.substr(5, 1000), "the file is cut off or no mesh");
  CheckBad("a.stl", text.substr(0, text.rfind("endfacet")), "ends inside a facet");
  CheckBad("a.stl", text.substr(0, text.rfind("vertex")), "ends inside a facet");
  CheckBad("a.stl", Replaced(text, "vertex 0 ", "vertex zero "),
           "has 'zero' where a number is needed");
  CheckBad("a.stl", Replaced(text, "vertex 0 ", "vertex nan "), "finite numbers are needed");
  CheckBad("a.stl",
           "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"
           "endfacet\nendsolid\n",
           "line 7 ends a facet of 2 vertices");
  CheckBad("a.stl", "solid empty\nendsolid\n", "holds no triangle");
  CheckBad("a.stl", "\x1f\x8b\x08", "no STL mesh: it is packed by gzip");
  CheckBad("a.stl", "ISO-10303-21;\n", "is a STEP model; export it as STL, OBJ or PLY");
  CheckBad("a.stl", "version https://git-lfs.github.com/spec/v1\n", "git lfs pull");
  CheckBad("a.step", "ISO-10303-21;\n", "(the file is a STEP model");
  std::string many = binary;
  const std::uint32_t count = 3'000'000;
  std::memcpy(many.data() + 80, &count, 4);
  many.resize(84 + 50 * std::size_t{count});
  CheckBad("a.stl", many, "claims 3000000 triangles, allowed are 2000000");
}

/// The pipe as PLY text with a header of one's own: vertex rows get `more` behind x y z.
std::string Ply(const std::string& vertex, const std::string& more, const std::string& face,
                const std::string& between = "") {
  const std::string text = TextPly(kPipe);
  std::string body = text.substr(text.find("end_header\n") + 11);
  std::string out = "ply\nformat ascii 1.0\ncomment a tube\nobj_info none\n" + vertex + face +
                    "end_header\n" + between;
  for (std::size_t i = 0; i < kPipe.vertices.size(); ++i) {
    const std::size_t end = body.find('\n');
    out += body.substr(0, end) + more + "\n";
    body = body.substr(end + 1);
  }
  return out + body;
}

TEST_CASE("PLY meshes may have lists, foreign types and elements anywhere", "[unit]") {
  const std::string n = std::to_string(kPipe.vertices.size());
  const std::string f = std::to_string(kPipe.faces.size());
  const std::string xyz =
      "element vertex " + n + "\nproperty float x\nproperty double y\nproperty float z\n";
  const std::string face = "element face " + f + "\nproperty list uchar int vertex_indices\n";
  CheckPipe("a.ply", Ply(xyz, "", face));
  CheckPipe("a.ply", Ply(xyz + "property list uchar int near\nproperty colour c\nproperty bool b\n",
                         " 2 0 1 red true", face));
  CheckPipe("a.ply", Ply("element material 2\nproperty list int uchar name\n" + xyz, "",
                         "element face " + f + "\nproperty list uint64 uint vertex_index\n",
                         "3 a b c\n0\n"));
  CheckBad("a.ply", Ply(xyz, "", ""), "holds no triangle");
  CheckBad("a.ply", Ply(xyz, "", "element face " + f + "\nproperty list uchar int corners\n"),
           "holds no triangle");
  CheckBad("a.ply", Ply(xyz, " 1", face), "element 'vertex', row 0: the line goes on with '1'");
  CheckBad("a.ply", Replaced(Ply(xyz, "", face), "float x", "float u"), "lacks property 'x'");
  CheckBad("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\n"
           "property int z\nelement face 1\nproperty list int int vertex_indices\n"
           "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
           "a face names vertex 3 of 3");
}

TEST_CASE("A PLY strip is triangles wound alike", "[unit]") {
  const Mesh mesh = Read(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty int x\nproperty int y\nproperty int z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n0 1 0\n1 0 0\n1 1 0\n5 5 0\n9 0 1 2 3 -1 1 4 3 -1\n");
  REQUIRE(mesh.faces.size() == 3);
  for (const auto& face : mesh.faces) {
    const auto at = [&](int k) { return mesh.vertices[static_cast<std::size_t>(face[k])]; };
    CHECK((at(1) - at(0)).cross(at(2) - at(0)).z() < 0);
  }
}

TEST_CASE("OBJ is read with what exporters put beside its faces", "[unit]") {
  const std::string obj = Obj(kPipe);
  CheckPipe("a.obj", "# made\r\nmtllib gone.mtl\r\no tube\r\ng one two\r\ns off\r\nusemtl red\r\n" +
                         Replaced(obj, "\n", "\r\n"));
  CheckPipe("a.OBJ", "\xef\xbb\xbf" + obj);
  CheckPipe("a.obj", "vt 0 0\nvn 0 0 1\n" + obj);
  CheckPipe("a.obj", obj + "l 1 2\np 1\n");
  CheckPipe("a.obj",
            "g An f Three\nvt 0 0\nvn 0 0 1 # up\n" + Replaced(obj, " ", " \\\n ") + "f 1 1 1\n");
  // Corners with texture and normal, and counted from the end.
  std::string with_corners = obj.substr(0, obj.find("f "));
  for (const auto& face : kPipe.faces) {
    with_corners += "f " + std::to_string(face[0] + 1) + "/1/1 " + std::to_string(face[1] + 1) +
                    "//1 " + std::to_string(face[2] - static_cast<int>(kPipe.vertices.size())) +
                    "/1\n";
  }
  CheckPipe("a.obj", with_corners);
  for (const char* corner : {"0", "-999999", "999999", "x", "1.5", "/1"}) {
    CheckBad("a.obj", obj + "f 1 2 " + corner + "\n",
             "has a face with corner '" + std::string(corner));
  }
  CheckBad("a.obj", "v 0 0,5 1\n" + obj, "line 1 has '0,5' where a vertex needs a number");
  CheckBad("a.obj", "v 0 nan 1\n" + obj, "finite numbers are needed");
  CheckBad("a.obj", "PK\x03\x04 zip", "no OBJ mesh: it is a zip archive");
}

}  // namespace
}  // namespace tubetwin
