#include "experiments/studies/continuum/mode_drawing.hpp"

#include "experiments/config/description.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/results/file.hpp"
#include "experiments/results/mode_figure.hpp"
#include "experiments/results/page/swing_model.hpp"
#include "experiments/results/vtk/mode_shapes.hpp"

namespace beamid::experiments {

Results begin_modes_report(const Experiment& experiment, Eigen::Index modes, Eigen::Index elements,
                           Eigen::Index coordinates) {
  Results results;
  results.command = "modes";
  results.configuration = describe(experiment);
  results.configuration["modes"] = modes;
  results.heading(experiment.title.empty() ? "Natural frequencies" : experiment.title);
  results.paragraph(structure_text(experiment, elements, coordinates));
  return results;
}

void draw_modes(const std::shared_ptr<const ModeDrawing>& drawn, bool surface, Results& results) {
  results.figures.push_back(mode_figure(drawn->system, drawn->shapes, drawn->frequencies_hz));
  results.attachments.push_back({{"modes.glb"}, [drawn](const std::filesystem::path& folder) {
                                   write_file(folder / "modes.glb",
                                              binary_gltf(mode_model(Picture(drawn->structure, drawn->system),
                                                                     drawn->shapes, drawn->frequencies_hz)));
                                 }});
  results.attachments.push_back(
      {mode_shape_files(drawn->shapes.cols()), [drawn, surface](const std::filesystem::path& folder) {
         write_mode_shapes(folder, Picture(drawn->structure, drawn->system, surface), drawn->shapes,
                           drawn->frequencies_hz);
       }});
}

}  // namespace beamid::experiments
