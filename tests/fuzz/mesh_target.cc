// The readers of STL, OBJ and PLY meshes.

#include <cstring>

#include "models/mesh/mesh.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/memory_file.h"
#include "tests/support/tube_mesh.h"

namespace tubetwin {
namespace {

constexpr const char* kMeshReader = "mesh reader";

void RequireSurface(const Mesh& mesh) {
  if (mesh.faces.empty()) DieOf(kMeshReader, "no face");
  for (const Vector3& p : mesh.vertices) {
    if (!p.allFinite()) DieOf(kMeshReader, "a vertex that is not finite");
  }
  const int n = static_cast<int>(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.faces) {
    if (a < 0 || b < 0 || c < 0 || a >= n || b >= n || c >= n || a == b || b == c || c == a) {
      DieOf(kMeshReader, "a face that is none");
    }
  }
}

}  // namespace

void TryBytes(std::string_view bytes) {
  static MemoryFile stl("x.stl"), ply("x.ply"), obj("x.obj");
  for (MemoryFile* file : {&stl, &ply, &obj}) {
    file->Fill(bytes);
    TryReader(kMeshReader, file->path(), [&] { RequireSurface(ReadMesh(file->path())); });
  }
}

std::vector<std::string> ByteCorpus() {
  const Mesh box = MakeBoxMesh({0, 0, 0}, {0.1, 0.2, 0.3});
  return {BinaryStl(box),
          "solid" + BinaryStl(box).substr(5) + "behind",
          TextStl(box),
          Obj(box) + "f 1 -2 3 4\nl 1 2\n",
          TextPly(box),
          BinaryPly(box),
          "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty int x\nproperty int y\n"
          "property list uchar int n\nproperty int z\nelement tristrips 1\n"
          "property list int int vertex_indices\nend_header\n0 0 0 0\n1 0 1 9 0\n0 1 0 0\n"
          "1 1 0 0\n7 0 1 2 3 -1 0 1\n"};
}

}  // namespace tubetwin
