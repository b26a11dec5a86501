// What every kind of structure owes to those that use it. Oracles: the definitions themselves (symmetry,
// energy, differences of assembled matrices), and the same structure described as another kind.
#include "fem/structure.hpp"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/modes.hpp"
#include "fem/parametric_system.hpp"
#include "fem/shear_building.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem::structure_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Quantity = BeamParameter::Quantity;

const std::vector<double> masses{1000.0, 1000.0, 800.0}, stiffnesses{2e6, 1.5e6, 1.2e6};

Structure chain() {
  return shear_building({masses, stiffnesses, {}, {}});
}

// The same three floors by their matrices, a factor for each storey.
MatrixSystem floors() {
  MatrixSystem system;
  Triplets mass;
  for (int i = 0; i < 3; ++i) mass.emplace_back(i, i, masses[static_cast<std::size_t>(i)]);
  system.mass = sparse(3, 3, mass);
  system.stiffness = SparseMatrix(3, 3);
  for (int i = 0; i < 3; ++i) {
    const double k = stiffnesses[static_cast<std::size_t>(i)];
    Triplets entries{{i, i, k}};
    if (i > 0)
      for (const auto& [row, column, value] : {std::tuple{i - 1, i - 1, k}, {i, i - 1, -k}, {i - 1, i, -k}})
        entries.emplace_back(row, column, value);
    system.parameters.push_back({"k" + std::to_string(i + 1), 1.0, {}, {}, sparse(3, 3, entries)});
  }
  system.labels = {"first", "second", "roof"};
  system.base_motion = VectorXd::Ones(3);
  return system;
}

Frame portal() {
  Section column, girder;
  column.bending_stiffness = 1.75e6, column.mass_per_length = 78.5, column.axial_stiffness = 2.1e9;
  girder.bending_stiffness = 3.0e6, girder.mass_per_length = 94.2, girder.axial_stiffness = 2.5e9;
  Frame frame;
  frame.joints = {{0, 0, "left_foot"}, {0, 3, "left"}, {4, 3, "right"}, {4, 0, ""}};
  frame.members = {{0, 1, column}, {1, 2, girder}, {3, 2, column}};
  frame.members[0].group = frame.members[2].group = "columns";
  frame.members[1].group = "girder";
  frame.supports = {{0}, {3}};
  frame.bodies = {{1, 800.0, 0.0}, {2, 700.0, 0.0}};
  return frame;
}

// A bent mast with a stay that is hinged: all its motions are coupled.
SpaceFrame mast() {
  SpaceSection section;
  section.axial_stiffness = 8e8, section.bending_stiffness_y = 6e5, section.bending_stiffness_z = 3e5;
  section.torsional_stiffness = 2.5e5, section.mass_per_length = 30.0, section.torsional_inertia = 0.04;
  SpaceFrame frame;
  frame.joints = {{{0, 0, 0}, ""}, {{0, 0, 4}, "knee"}, {{1.5, 0.5, 5}, "head"}, {{2, 2, 0}, ""}};
  frame.members = {{0, 1, section}, {1, 2, section}, {3, 1, section}};
  frame.members[1].section.shear_stiffness_y = frame.members[1].section.shear_stiffness_z = 1e8;
  frame.members[0].group = frame.members[1].group = "mast";
  frame.members[2].group = "stay";
  frame.members[2].at_second.y = frame.members[2].at_second.z = true;
  frame.supports = {{0}, {3}};
  frame.bodies = {{2, 900.0, Eigen::Vector3d(20, 20, 10), Eigen::Vector3d(0.2, 0, 0.1)}};
  frame.springs = {{2, Eigen::Vector3d(1e4, 0, 0), Eigen::Vector3d::Zero()}};
  frame.base_direction = {3, 4, 0};
  return frame;
}

struct Case {
  const char* name;
  Structure structure;
  std::vector<Point> points;
  std::vector<BeamParameter> parameters;
};

std::ostream& operator<<(std::ostream& stream, const Case& one) {
  return stream << one.name;
}

class AnyStructure : public testing::TestWithParam<Case> {
 protected:
  static constexpr int elements = 3;
  const Case& tested() const { return GetParam(); }
  StructuralSystem system() const { return assemble(tested().structure, elements, tested().points); }
};

TEST_P(AnyStructure, HasSymmetricMatricesAndPositiveMass) {
  const StructuralSystem found = system();
  const MatrixXd mass = found.mass, stiffness = found.stiffness.assembled();
  EXPECT_LE((mass - mass.transpose()).cwiseAbs().maxCoeff(), 1e-12 * mass.cwiseAbs().maxCoeff());
  EXPECT_LE((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff(),
            1e-12 * stiffness.cwiseAbs().maxCoeff());
  EXPECT_EQ(mass.llt().info(), Eigen::Success);
}

TEST_P(AnyStructure, HasTheEnergyOfItsStiffness) {
  const StructuralSystem found = system();
  const VectorXd motion = VectorXd::LinSpaced(found.size(), 1.0, 2.0).array().sin();
  const double energy = motion.dot(found.stiffness.assembled() * motion);
  EXPECT_NEAR(found.stiffness.energy(motion) / energy, 1.0, 1e-9);
}

TEST_P(AnyStructure, SolvesItsStaticsToRounding) {
  const StructuralSystem found = system();
  const VectorXd load = found.inputs.col(0);
  const VectorXd there = StiffnessSolver(found.stiffness).solve(load);
  EXPECT_LE((found.stiffness.assembled() * there - load).norm(), 1e-8 * load.norm());
}

// The base's column is - M r of the motion r that all take from the base, and a sensor sees r where it sits,
// to the mass that elements at a support share with it: of eight elements little is left beyond.
TEST_P(AnyStructure, FollowsItsBase) {
  const StructuralSystem found = assemble(tested().structure, 8, tested().points);
  const VectorXd pull = found.inputs.col(found.inputs.cols() - 1);
  const VectorXd follows = -MatrixXd(found.mass).ldlt().solve(pull);
  const VectorXd seen = found.outputs * follows;
  const bool framed = tested().structure.frame() || tested().structure.space_frame();
  const double shared = framed ? 1e-4 : 1e-9;
  for (Index i = 0; i < seen.size(); ++i)
    EXPECT_NEAR(seen[i], found.base_shares.size() > 0 ? found.base_shares[i] : 1.0, shared) << i;
  EXPECT_EQ(found.input_names.back(), "base_acceleration");
}

TEST_P(AnyStructure, HasTheDerivativesOfItsDifferences) {
  const ParametricSystem exact =
      assemble_parametric(tested().structure, elements, tested().points, tested().parameters);
  for (std::size_t j = 0; j < tested().parameters.size(); ++j) {
    const BeamParameter& parameter = tested().parameters[j];
    const double value = value_of(tested().structure, parameter), step = 0.25 * value;
    EXPECT_DOUBLE_EQ(exact.values[static_cast<Index>(j)], value);
    const StructuralSystem more =
        assemble(with_value(tested().structure, parameter, value + step), elements, tested().points);
    const MatrixXd by_difference =
        (more.stiffness.assembled() - exact.system.stiffness.assembled()).toDense() / step;
    EXPECT_LE((MatrixXd(exact.stiffness_derivative(j)) - by_difference).cwiseAbs().maxCoeff(),
              1e-9 * by_difference.cwiseAbs().maxCoeff());
  }
}

TEST_P(AnyStructure, KeepsAValueThatItIsGiven) {
  for (const BeamParameter& parameter : tested().parameters) {
    const Structure changed =
        with_value(tested().structure, parameter, 0.7 * value_of(tested().structure, parameter));
    EXPECT_NEAR(value_of(changed, parameter) / value_of(tested().structure, parameter), 0.7, 1e-14);
  }
}

TEST_P(AnyStructure, RefusesPlacesThatItDoesNotHave) {
  EXPECT_THROW(assemble(tested().structure, elements, {{"nowhere", 1e6, "nowhere"}}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, AnyStructure,
    testing::Values(Case{"chain",
                         chain(),
                         {{"first", 1.0}, {"roof", 3.0}},
                         {{Quantity::storey_stiffness, std::pair{0.0, 1.0}},
                          {Quantity::storey_stiffness, std::pair{1.0, 3.0}}}},
                    Case{"system",
                         floors(),
                         {{"first", 0.0, "first"}, {"roof", 0.0, "roof"}},
                         {{Quantity::factor, {}, "k1"}, {Quantity::factor, {}, "k3"}}},
                    Case{"frame",
                         portal(),
                         {{"a", 0.0, "left.x"}, {"b", 0.0, "right.y"}},
                         {{Quantity::factor, {}, "columns"}, {Quantity::factor, {}, "girder"}}},
                    Case{"space_frame",
                         mast(),
                         {{"a", 0.0, "knee.x"}, {"b", 0.0, "head.y"}, {"c", 0.0, "head.z"}},
                         {{Quantity::factor, {}, "mast"}, {Quantity::factor, {}, "stay"}}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(MatrixSystem, HasTheModesOfTheSameChain) {
  const Modes by_matrices = modes(assemble(floors(), std::vector<Point>{}), 3),
              as_chain = modes(assemble(chain(), 1), 3);
  for (Index i = 0; i < 3; ++i)
    EXPECT_NEAR(by_matrices.angular_frequency[i] / as_chain.angular_frequency[i], 1.0, 1e-12);
}

TEST(MatrixSystem, SaysWhatIsWrongWithItsMatrices) {
  const auto message = [](const MatrixSystem& system) {
    try {
      assemble(system, std::vector<Point>{});
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  MatrixSystem skew = floors();
  skew.mass.coeffRef(0, 1) = 3.0;
  EXPECT_EQ(message(skew), "mass: entry (1, 2) is 3 and (2, 1) is 0; expected a symmetric matrix");
  MatrixSystem loose = floors();
  loose.parameters[0].value = 0.0;
  EXPECT_THAT(message(loose), testing::HasSubstr("the structure can move without strain"));
  MatrixSystem doubled = floors();
  doubled.labels[2] = "first";
  EXPECT_EQ(message(doubled), "two unknowns are called 'first'; expected different labels");
  MatrixSystem small = floors();
  small.parameters[1].stiffness = SparseMatrix(2, 2);
  EXPECT_EQ(message(small), "stiffness of k2 is 2 x 2; expected 3 x 3 as the mass matrix");
}

TEST(Frame, NamesThePlacesThatCanMove) {
  EXPECT_THAT(place_names(portal()), testing::ElementsAre("left.x", "left.y", "right.x", "right.y"));
  EXPECT_THAT(factor_names(portal()), testing::ElementsAre("columns", "girder"));
  EXPECT_THROW(assemble(Structure(portal()), 2, {{"foot", 0.0, "left_foot.x"}}), std::invalid_argument);
}

TEST(SpaceFrame, NamesThePlacesThatCanMove) {
  EXPECT_THAT(place_names(mast()),
              testing::ElementsAre("knee.x", "knee.y", "knee.z", "head.x", "head.y", "head.z"));
  EXPECT_THAT(factor_names(mast()), testing::ElementsAre("mast", "stay"));
  EXPECT_STREQ(Structure(mast()).kind(), "space_frame");
  EXPECT_DOUBLE_EQ(Structure(mast()).extent(), std::sqrt(4.0 + 4.0 + 25.0));
}

// The share of a direction is its cosine.
TEST(SpaceFrame, MovesWithItsBaseAlongADirection) {
  const std::vector<Point> points{{"a", 0.0, "head.x"}, {"b", 0.0, "head.y"}, {"c", 0.0, "head.z"}};
  EXPECT_TRUE(assemble(Structure(mast()), 2, points).base_shares.isApprox(Eigen::Vector3d(0.6, 0.8, 0)));
}

// A sensor across the base's motion does not see it.
TEST(Frame, MovesWithItsBaseAlongOneAxis) {
  Frame along_y = portal();
  along_y.base_axis = 'y';
  const std::vector<Point> points{{"a", 0.0, "left.x"}, {"b", 0.0, "left.y"}};
  EXPECT_EQ(assemble(Structure(portal()), 2, points).base_shares, Eigen::Vector2d(1, 0));
  EXPECT_EQ(assemble(Structure(along_y), 2, points).base_shares, Eigen::Vector2d(0, 1));
}

TEST(Structure, SaysThatItIsNoBeam) {
  EXPECT_THAT([] { Structure(portal()).beam(); },
              testing::ThrowsMessage<std::invalid_argument>(
                  "this needs a beam; found a frame. Expected [beam] in the experiment file"));
}

}  // namespace
}  // namespace beamid::fem::structure_test
