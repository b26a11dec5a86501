// The closed form of the oscillator's motion and of its tangents, as filters of fixed sizes use it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "beamid/testing/oscillator.hpp"
#include "filters/algorithms/oscillator.hpp"
#include "filters/central_differences.hpp"
#include "filters/scheme.hpp"
#include "filters/schemes/matrix_exponential.hpp"

namespace beamid::oscillator_motion_test {
namespace {

using Eigen::Matrix4d, Eigen::Vector4d, Eigen::VectorXd;
using filters::Quantity, filters::algorithms::Lanes;
using Motion = filters::algorithms::Oscillator<double, 3>;
using Pair = Lanes<2, filters::algorithms::Baseline>;
using PairMotion = filters::algorithms::Oscillator<Pair, 3>;

constexpr std::array all{Quantity::displacement, Quantity::velocity, Quantity::acceleration};

Motion motion(double mass, double dt) {
  return {mass, dt, all, Matrix4d::Zero(), Eigen::Matrix3d::Identity()};
}

struct Reference {
  double mass, stiffness, damping, dt;
  /// x+ and v+ from x = 0.012, v = -0.3; e^(A dt) by rows; the derivatives of x+ and v+ by K, then by C.
  double values[10];
};

// Oracle: Taylor series with scaling and squaring in rational arithmetic rounded to 70 digits, of the doubles
// as they are; derivatives from the block matrix [A D; 0 A]. Light and heavy damping, critical but for
// rounding, strongly overdamped, three periods in one step, unstable, and free.
const Reference references[] = {
    {3.0,
     515.8,
     0.118,
     0.001,
     {1.16989829246518534794e-02, -3.02025511581621386448e-1, 9.99914035692125668930e-1,
      9.99951678845516049587e-04, -1.71925025316172402912e-1, 9.99874704259424373909e-1,
      -1.98325041597428066312e-09, -3.94969484120815991887e-06, 5.01118741739042667708e-08,
      1.00334183672353942775e-04}},
    {3.0,
     515.8,
     7.867,
     0.001,
     {1.16993709076308755740e-02, -3.01249024124893627352e-1, 9.99914109658927352520e-1,
      9.98661360920842988351e-04, -1.71703176654323580452e-1, 9.97295286683472559375e-1,
      -1.98155112784736204369e-09, -3.94461972932636962007e-06, 5.00257143570023798711e-08,
      1.00075646684383336442e-04}},
    {3.0,
     515.8,
     7.867,
     0.1,
     {-1.56699866398826020975e-02, -1.77516202460144684183e-1, 3.15730670846704863930e-1,
      6.48625156334768776523e-02, -1.11520285212491234716e+01, 1.45639534017184019143e-1,
      -1.33949751778447643041e-06, 1.33197717226491406124e-04, 3.92647779760398919768e-04,
      5.68690247544707903199e-03}},
    {3.0,
     515.8,
     40.0,
     0.25,
     {-3.30580460717022411518e-03, 5.34758771316837591692e-02, -1.44402513786097919102e-1,
      5.24324813912349814438e-03, -9.01489130053300002920e-1, -2.14312488974411213816e-1,
      1.17824771591133043141e-05, 4.87055146264236512774e-05, 6.96785071829176454270e-05,
      -2.43052252141676616501e-03}},
    {2.0,
     50.0,
     20.0,
     0.05,
     {1.56716464174358091009e-19, -1.86912187937137153071e-1, 9.73500978839256125852e-1,
      3.89400391535702425361e-02, -9.73500978839256125852e-1, 5.84100587303553631102e-1,
      -3.89400391535702462088e-06, -9.73500978839256095928e-05, 1.36290137037495864272e-04,
      4.57545460054450351534e-03}},
    {2.0,
     50.0,
     20.000001,
     0.05,
     {1.36290136251292794199e-10, -1.86912183361682610050e-1, 9.73500979042068781411e-1,
      3.89400387073823017747e-02, -9.73500967684557516613e-1, 5.84100572498226444651e-1,
      -3.89400389588700501661e-06, -9.73500973728375979454e-05, 1.36290134871456191344e-04,
      4.57545448664489068369e-03}},
    {1.0,
     100.0,
     400.0,
     0.05,
     {1.11166564556818801834e-02, -2.78090388597573108173e-03, 9.88188466433973178304e-1,
      2.47201713841932848095e-03, -2.47201713841932846361e-1, -6.18388933758210715581e-04,
      -1.32626921518595776043e-06, -2.74946711853714327633e-05, 2.16953447566050862193e-06,
      6.41827278019078312536e-06}},
    {1.0,
     1.0,
     0.0,
     20.0,
     {-2.68986590476527565041e-1, -1.33379961552749115583e-1, 4.08082061813391960836e-1,
      9.12945250727627666265e-1, -9.12945250727627666265e-1, 4.08082061813391960836e-1,
      -1.19685782791834705030e+00, 2.68438823326090991728e+00, 2.69534357626964160559e+00,
      1.47074140313663548341e+00}},
    {1.0,
     -4.0,
     0.5,
     0.1,
     {-1.72209752396854480494e-02, -2.86478714085862284922e-1, 1.01973622892376969418e+00,
      9.81926999559022961606e-02, 3.92770799823609184642e-1, 9.70639878945818601608e-1,
      -1.04413658245680755673e-05, 2.74502903705000733496e-04, 1.45281530317582828829e-03,
      2.86896368718844996248e-02}},
    {0.5,
     0.0,
     0.0,
     0.3,
     {-7.79999999999999998890e-02, -2.99999999999999988898e-1, 1.00000000000000000000e+00,
      2.99999999999999988898e-1, 0.00000000000000000000e+00, 1.00000000000000000000e+00,
      1.61999999999999969545e-03, 1.97999999999999981570e-02, 2.69999999999999962252e-02,
      1.79999999999999993339e-01}},
};

TEST(OscillatorMotion, AgreesWithSeventyDigitsUnderCriticalAndOverDamping) {
  for (const Reference& reference : references) {
    const auto [mass, k, c, dt, expected] = reference;
    Vector4d next;
    Matrix4d jacobian;
    motion(mass, dt).linearised_transition(Vector4d(0.012, -0.3, k, c), next, jacobian);
    const double found[10] = {next[0],        next[1],        jacobian(0, 0), jacobian(0, 1), jacobian(1, 0),
                              jacobian(1, 1), jacobian(0, 2), jacobian(1, 2), jacobian(0, 3), jacobian(1, 3)};
    // Rounding the argument of cos, sin or exp once costs eps times that argument.
    const double argument = std::max(1.0, (std::sqrt(std::abs(k) / mass) + c / mass) * dt);
    const auto near = [&](int first, int count, double scale) {
      for (int i = first; i < first + count; ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-15 * argument * scale)
            << "value " << i << " at K " << k << ", C " << c << ", dt " << dt;
    };
    const double frequency = std::max(1.0, std::sqrt(std::abs(k) / mass));  // 1/s: of v beside x
    near(0, 2, std::abs(expected[1]) + frequency * std::abs(expected[0]) + 0.02);
    near(2, 4, std::max(1.0, std::abs(expected[4])));
    const double moved = dt / mass * std::max(std::abs(expected[2]), std::abs(expected[5])) * 0.3;
    near(6, 2, std::abs(expected[6]) + std::abs(expected[7]) + dt * moved);
    near(8, 2, std::abs(expected[8]) + std::abs(expected[9]) + moved);
  }
}

TEST(OscillatorMotion, IsTheExponentialScheme) {
  // Oracle: the general scheme on the same model.
  const auto scheme = filters::scheme_registry().make("exponential", {});
  const test::Oscillator model(3.0);
  for (const double dt : {1e-3, 0.02, 0.3})
    for (const double damping : {0.1, 7.867, 78.67, 200.0}) {
      const Vector4d z(0.012, -0.3, 515.8, damping);
      Vector4d next;
      Matrix4d jacobian;
      motion(3.0, dt).linearised_transition(z, next, jacobian);
      VectorXd other;
      Eigen::MatrixXd tangent;
      scheme->step(model, z, {}, dt, other, &tangent);
      EXPECT_LT((next - other).norm(), 1e-14 * other.norm());
      EXPECT_LT((jacobian - tangent).norm(), 1e-14 * tangent.norm());
    }
}

/// Central differences at z of a function whose result is a Result of fixed size.
template <class Result, class Function>
Eigen::MatrixXd slopes_by_differences(const Function& function, const VectorXd& z) {
  Eigen::MatrixXd slopes;
  const auto f = [&](const VectorXd& at, VectorXd& value) {
    Result result;
    function(at, result);
    value = result;
  };
  filters::central_differences(f, z, Result::RowsAtCompileTime, slopes);
  return slopes;
}

TEST(OscillatorMotion, HasTheJacobianOfItsOutputs) {
  // Oracle: central differences.
  const Motion model = motion(3.0, 1e-3);
  const Vector4d z(0.012, -0.3, 515.8, 7.867);
  Eigen::Matrix<double, 3, 4> jacobian;
  model.output_jacobian(z, jacobian);
  const Eigen::MatrixXd difference = slopes_by_differences<Eigen::Vector3d>(
      [&](const VectorXd& at, Eigen::Vector3d& y) { model.output(at, y); }, z);
  EXPECT_LT((jacobian - difference).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(OscillatorMotion, OfAMeasuredSignalIsThatOfItsMode) {
  // Oracle: e^(A dt) of y'' + 2 xi w y' + w^2 y = 0 by Exponential2x2, central differences; small and large
  // steps, stiffness near to what is expected and far from it.
  using Ringing = filters::algorithms::RingingOscillator<double>;
  const double w0 = 46.0;
  for (const double dt : {1e-3, 0.02})
    for (const double k : {0.0, 0.3, -1.2}) {
      const Ringing model(w0, dt, Ringing::State::Zero().asDiagonal().toDenseMatrix(),
                          Eigen::Matrix<double, 1, 1>::Ones());
      Ringing::State z(0.012, -0.3, k, 0.02, 0.005), next;
      Eigen::Matrix<double, 5, 5> jacobian;
      model.linearised_transition(z, next, jacobian);
      const double w = w0 * std::exp(0.5 * k);
      Eigen::Matrix2d motion;
      motion << 0.0, 1.0, -w * w, -2.0 * z[3] * w;
      const Eigen::Vector2d moved = filters::Exponential2x2(motion * dt).value() * z.head<2>();
      EXPECT_LT((next.head<2>() - moved).norm(), 1e-13 * moved.norm()) << dt << " " << k;
      EXPECT_EQ(next.tail<3>(), z.tail<3>());
      const Eigen::MatrixXd difference = slopes_by_differences<Ringing::State>(
          [&](const VectorXd& at, Ringing::State& moved_state) { model.transition(at, moved_state); }, z);
      EXPECT_LT((jacobian - difference).cwiseAbs().maxCoeff(), 1e-8 * difference.cwiseAbs().maxCoeff());
    }
}

TEST(OscillatorMotion, GivesEveryLaneWhatAScalarGets) {
  // One lane needs its argument halved four times, the other not at all.
  const Vector4d slow(0.012, -0.3, 515.8, 0.118), fast(0.02, 0.1, 4e6, 900.0);
  const PairMotion pair(3.0, 1e-3, all, filters::algorithms::Matrix<Pair, 4>::Zero(),
                        filters::algorithms::Matrix<Pair, 3>::Identity());
  filters::algorithms::Vector<Pair, 4> z, next;
  for (int i = 0; i < 4; ++i) z[i] = Pair(Pair::Values{slow[i], fast[i]});
  pair.transition(z, next);
  for (int lane = 0; lane < 2; ++lane) {
    Vector4d alone;
    motion(3.0, 1e-3).transition(lane == 0 ? slow : fast, alone);
    for (int i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(next[i][lane], alone[i]);
  }
}

TEST(OscillatorMotion, MovesManyPointsAsItMovesOne) {
  Eigen::Matrix<double, 4, 9> points, moved;
  for (int i = 0; i < 9; ++i) points.col(i) << 0.01 * i, 0.3 - 0.1 * i, 500.0 + 90.0 * i * i * i, 0.1 * i;
  const Motion model = motion(3.0, 0.01);
  model.transitions(points, moved);
  for (int i = 0; i < 9; ++i) {
    Vector4d alone;
    model.transition(points.col(i), alone);
    EXPECT_LT((moved.col(i) - alone).norm(), 1e-15 * alone.norm());
  }
}

TEST(OscillatorMotion, OfWhatIsNoNumberIsNoNumber) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const double k : {infinite, -infinite, std::nan(""), 1e300}) {
    Vector4d next;
    motion(3.0, 1e-3).transition(Vector4d(0.012, -0.3, k, 1.0), next);
    EXPECT_FALSE(std::isfinite(next[0])) << k;
  }
}

}  // namespace
}  // namespace beamid::oscillator_motion_test
