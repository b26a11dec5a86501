// A joint filter on a whole frame: processor time per sample, for meshes of several sizes.
//
//     frame_bench cost [SAMPLES] [ELEMENTS ...]    one line per mesh, ELEMENTS of each member
//     frame_bench storeys [SAMPLES] [STOREYS ...]  the same of higher frames, 4 elements of each member
//     frame_bench record [ELEMENTS] [SECONDS]      one pass of the filter low_rank_ekf over a record at 200
//     Hz
//
// Six storeys of two bays in steel: 18 free joints, 30 members. Unknown are the stiffness of the columns of
// the lower half, of the upper half and of the girders, and the damping ratio of the first three modes; the
// base moves, and four floors have accelerometers. With the start of these modes uncertain the covariance has
// rank 10.
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "fem/structure.hpp"
#include "tests/bench/mesh_problem.hpp"

namespace {

using namespace beamid;
using namespace beamid::bench;
using experiments::Drive, experiments::Quantity;

constexpr double interval = 5e-3;  // [s]

fem::Frame tower(int storeys) {
  const auto section = [](double width, double height) {
    const double e = 2.1e11, area = width * height;
    fem::Section made;
    made.bending_stiffness = fem::Variation(e * fem::rectangle_second_moment(width, height));
    made.mass_per_length = fem::Variation(7850.0 * area);
    made.axial_stiffness = fem::Variation(e * area);
    return made;
  };
  fem::Frame frame;
  for (int level = 0; level <= storeys; ++level)
    for (int line = 0; line < 3; ++line)
      frame.joints.push_back({5.0 * line, 3.2 * level, std::to_string(level) + std::string(1, "abc"[line])});
  for (int level = 1; level <= storeys; ++level)
    for (int line = 0; line < 3; ++line) {
      const int top = 3 * level + line;
      frame.members.push_back(
          {top - 3, top, section(0.2, 0.2), false, false, 1.0, 2 * level <= storeys ? "lower" : "upper"});
      if (line > 0)
        frame.members.push_back({top - 1, top, section(0.15, 0.25), false, false, 1.0, "girders"});
      frame.bodies.push_back({top, 2000.0});
    }
  for (int line = 0; line < 3; ++line) frame.supports.push_back({line});
  return frame;
}

Problem make_problem(int storeys, int elements) {
  const fem::BeamParameter lower{fem::BeamParameter::Quantity::factor, {}, "lower"};
  fem::BeamParameter upper = lower, girders = lower;
  upper.name = "upper";
  girders.name = "girders";
  std::vector<fem::Point> points;
  for (const int share : {1, 2, 3, 4})
    points.push_back({"floor", 0.0, std::to_string((storeys * share + 3) / 4) + "a.x"});
  Problem problem;
  problem.equations = fem::assemble_parametric(tower(storeys), elements, points, {lower, upper, girders});
  problem.modes = fem::modes(problem.equations.system, mode_count);
  experiments::MotionDescription& description = problem.description;
  description.reference = problem.equations.values;
  for (const char* const name : {"lower", "upper", "girders"})
    description.unknowns.push_back({name, "", 1.0, 0.05});
  description.unknowns.push_back({"damping_ratio", "", 0.02, 0.005});
  description.drives = {{Drive::Kind::property, 0},
                        {Drive::Kind::property, 1},
                        {Drive::Kind::property, 2},
                        {Drive::Kind::damping_ratio, -1}};
  description.observations.assign(4, {Quantity::acceleration});
  description.forces = {problem.equations.system.inputs.cols() - 1};
  description.base = 0;
  description.carried = MatrixXd::Ones(4, 1);
  damp_modes(3, problem);
  start_in_modes(VectorXd::Zero(mode_count), 0.1, problem);
  return problem;
}

// A moving base, smooth: value, and what it changes by until the next sample.
VectorXd ground(double time) {
  const auto at = [](double t) {
    return 0.8 * std::sin(6.0 * t) + 0.5 * std::sin(17.0 * t + 1.0) + 0.3 * std::sin(41.0 * t);
  };
  return Eigen::Vector2d(at(time), at(time + interval) - at(time));
}

void record(int elements, double length) {
  const Problem problem = make_problem(6, elements);
  const auto samples = static_cast<Index>(length / interval);
  const Index n = problem.equations.system.size(), first = layout(problem.description, n).unknowns;
  const double truth[] = {1.03, 0.98, 1.02, 0.018};
  VectorXd state = VectorXd::Zero(problem.start.mean.size()), next, read;
  for (Index j = 0; j < 4; ++j) state[first + j] = truth[j];
  MatrixXd history(4, samples);
  const auto source = discrete(problem, interval);
  std::srand(3);
  for (Index k = 0; k < samples; ++k) {
    const VectorXd input = ground(interval * static_cast<double>(k));
    source->output(state, input.head(1), read);
    history.col(k) = read;
    for (Index i = 0; i < 4; ++i)  // noise of 0.05 m/s2, from twelve uniform numbers
      for (int part = 0; part < 12; ++part)
        history(i, k) += 0.05 * (static_cast<double>(std::rand()) / RAND_MAX - 0.5);
    source->transition(state, input, next);
    state.swap(next);
  }
  auto filter = filters::filter_registry().make("low_rank_ekf", {}, discrete(problem, interval));
  filter->reset(problem.start);
  const double from = processor_seconds();
  for (Index k = 0; k < samples; ++k) {
    const VectorXd input = ground(interval * static_cast<double>(k));
    filter->correct(history.col(k), input.head(1));
    if (k + 1 < samples) filter->predict(input);
  }
  const double spent = processor_seconds() - from;
  std::printf(
      "%ld coordinates, rank %ld, %.0f s at %.0f Hz (%ld samples) filtered in %.2f s: %.1f us per sample, "
      "%.1f times faster than the record\n",
      static_cast<long>(n), static_cast<long>(problem.start.factor.cols()), length, 1.0 / interval,
      static_cast<long>(samples), spent, 1e6 * spent / static_cast<double>(samples), length / spent);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "cost";
  if (what == "record") {
    record(argc > 2 ? std::atoi(argv[2]) : 23, argc > 3 ? std::atof(argv[3]) : 60.0);
    return 0;
  }
  std::vector<int> sizes;
  for (int i = 3; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
  const bool higher = what == "storeys";
  if (sizes.empty())
    sizes = higher ? std::vector{6, 12, 24, 50, 120, 240} : std::vector{3, 6, 11, 23, 56, 111};
  const Index samples = argc > 2 ? std::atoi(argv[2]) : 400;
  std::printf(cost_columns);
  for (const int size : sizes)
    print_cost(higher ? make_problem(size, 4) : make_problem(6, size), interval, ground(1.0),
               std::max<Index>(20, samples * 23 / (23 + size)));
}
