// The readers of piles: pile.json, CSV and the public set's text.

#include "scenes/pile.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/memory_file.h"

namespace tubetwin {

void TryBytes(std::string_view bytes) {
  static MemoryFile file("pile");
  file.Fill(bytes);
  TryReader("pile reader", file.path(), [] {
    const Pile pile = LoadPile(file.path());
    // What was read is a pile by every rule.
    ValidatePile(pile, file.path());
    for (const PileTube& tube : pile.tubes) {
      if (Length(tube.centerline_N) > 10.0) DieOf("pile reader", "a tube that no bin holds");
    }
  });
}

std::vector<std::string> ByteCorpus() {
  return {
      "tube,index,x,y,z\n3,0,0,0,0.02\n3,1,0.1,0,0.02\n9,0,0,0.2,0.01\n9,1,0.1,0.25,0.01\n",
      "\xef\xbb\xbfsep=;\n;\"tube\";index;x [mm];y [mm];z [mm];radius_mm\r\n"
      "0;3;2;100,5;0;+20,0;12\r\n1;3;1;0;0;20;12\r\n;;;;;;\r\n",
      "2\n3 3 2\n2 0.2 0.1 0.0125 0.0125\n4 0.1 0 0.02 0.0125\n1 0 0 0.02 0.0125\n"
      "e_4_2 4 2 2 0.0125 0 0 0 1 0 0 0 0.1\ne_1_4 1 4 1 0.0125 0 0 0 1 0 0 0 0.1\n"
      "9 2 1\n1 0 0.2 0.01 0.0125\n2 0.1 0.25 0.01 0.0125\n"
      "e_1_2 1 2 1 0.0125 0 0 0 1 0 0 0 0.1\n",
      R"({"schema": "tubetwin/pile/1", "bin": {"size_m": [0.77, 0.58, 0.09]}, "part": "pvc_a",
 "tubes": [{"id": 4, "centerline_m": [[-0.24, 0, 0.0125], [0.26, 0, 0.0125]], "radius_m": 0.0125,
 "mass_kg": 0.055}], "seed": 1, "settled": false})",
      R"({"schema": "tubetwin/pile/1", "bin": {"size_m": [0.8, 0.6, 0.1]}, "part": {"name": "mine",
 "radius_m": 0.01}, "tubes": [{"id": 0, "centerline_m": [[0, 0, 0.1], [0.3, 0, 0.1]]}]})"};
}

}  // namespace tubetwin
