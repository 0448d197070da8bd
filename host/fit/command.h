#pragma once
#include "host/commands.h"

namespace wale {

struct FitArgs : SceneArgs {
  std::filesystem::path front, back, output;  ///< photographs; the material to write
  std::filesystem::path report, progress;     ///< page and picture to write; empty: none
  std::string command;                        ///< as it was typed, for the report
  std::string material;                       ///< empty: the scene's only ply material
  std::string parameters;                     ///< as fit_parameters() reads them
  double resolution = 0.1;                    ///< of the photographs' size
  int samples = 32, final_samples = 1024, starts = 3, evaluations = 150;
  std::string method = "paths";
  double minutes = 0;  ///< 0: as long as it takes
  bool redo = false;   ///< forget what an earlier run left
  // Photographs; lists are numbers with commas between them.
  std::string transfer, grey, gains, crop, corners;
  double grey_reflectance = 0.18;
  double front_exposure = 1, back_exposure = 1;
  double clip_level = 0;  ///< stored value from which a pixel is clipped; 0: what the file's format says
  // Loss.
  bool unaligned = false;
  std::filesystem::path weights;  ///< of a VGG16; empty: none
  std::string terms;              ///< "low-pass=1,color=1,...", as loss_options() reads them
  std::string layers;             ///< "relu1_2=1,relu2_2=1"
};

/// Fits a material to photographs that are lit from the front and from behind, and writes it.
int run_fit(const FitArgs& args, const Loaders& loaders);

}  // namespace wale
