#pragma once

#include "models/cell_model.h"

namespace tubetwin {

/// The cell of the paper, which most tests are about.
inline const CellModel& PaperCell() {
  static const CellModel model = LoadCellModel("leao2020");
  return model;
}

}  // namespace tubetwin
