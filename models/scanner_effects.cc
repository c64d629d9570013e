#include "models/scanner_effects.h"

namespace tubetwin {

ScannerEffects ScannerEffects::Exact() {
  ScannerEffects out;
  out.soft_range = out.incidence = out.weak_signal = out.highlights = false;
  out.flying_pixels = out.interreflections = out.noise = out.bias = false;
  return out;
}

void ScannerEffects::Visit(ConfigVisitor& v) {
  v.Field("shadows", "empty where the projector's light does not get", shadows);
  v.Field("hard_range", "nothing outside of the data sheet's 384 to 520 mm", hard_range);
  v.Field("soft_range", "fewer points too near and too far", soft_range);
  v.Field("incidence", "fewer points on steep surfaces", incidence);
  v.Field("weak_signal", "fewer points where little light comes back: dark, steep, far",
          weak_signal);
  v.Field("highlights", "fewer points where glossy surfaces mirror the projector", highlights);
  v.Field("flying_pixels", "empty and mixed pixels at depth edges", flying_pixels);
  v.Field("interreflections", "false points in valleys", interreflections);
  v.Field("noise", "depth noise, growing with distance and incidence", noise);
  v.Field("bias", "slow calibration error of depth", bias);
}

}  // namespace tubetwin
