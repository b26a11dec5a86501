#include "experiments/models/motion/second_order_step.hpp"

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/motion/rational_step.hpp"
#include "filters/nonzeros.hpp"
#include "filters/observed_model.hpp"
#include "filters/schemes/forced_oscillator.hpp"
#include "filters/schemes/matrix_exponential.hpp"

namespace beamid::experiments {
namespace {

// The step of second-order motion, and its derivatives, where the unknowns stay from sample to sample.

/// Linear in the motion x = [z, z'] and in the chain of the inputs (RationalStep::chain_of):
///
///     x+ = F [x; vec chain],   d x+ / d eta_j = F_j [x; vec chain]
///
/// Made of one step of each unit vector: output error, which walks a whole record at the same unknowns, takes
/// a product with F and F_j for every sample instead of the sums of rational_step.hpp.
class HeldStep {
 public:
  /// Steps of unit vectors that F and F_j take (columns).
  static Eigen::Index columns(const SecondOrderForm& form, Eigen::Index powers) {
    return 2 * form.stiffness.rows() + form.inputs.cols() * powers;
  }

  /// @param step which is set to other inputs afterwards
  /// @param powers d + 1 of the inputs; 0 without any
  HeldStep(RationalStep& step, const SecondOrderForm& form, const std::vector<SecondOrderForm>& slopes,
           Eigen::Index powers);

  bool takes(const Eigen::MatrixXd& chain) const { return chain.cols() == powers_; }
  /// @param state begins with x, as `next` does @param tangent d x+ / d x (2r x 2r)
  /// @param by_unknowns d x+ / d eta (2r x q)
  void step(const Eigen::VectorXd& state, const Eigen::MatrixXd& chain, Eigen::VectorXd& next,
            Eigen::Ref<Eigen::MatrixXd> tangent, Eigen::Ref<Eigen::MatrixXd> by_unknowns);

 private:
  Eigen::Index moving_, powers_;
  Eigen::MatrixXd value_, slope_;  // F (2r x columns), F_j one below the other
  Eigen::VectorXd joined_, sloped_;
};

using Eigen::Index, Eigen::Matrix2d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

HeldStep::HeldStep(RationalStep& step, const SecondOrderForm& form,
                   const std::vector<SecondOrderForm>& slopes, Index powers)
    : moving_(2 * form.stiffness.rows()), powers_(powers) {
  const Index all = columns(form, powers), q = static_cast<Index>(slopes.size());
  value_.resize(moving_, all);
  slope_.resize(moving_ * q, all);
  joined_.resize(all);
  MatrixXd along(moving_, q);
  VectorXd state = VectorXd::Zero(moving_), next(moving_);
  const auto keep = [&](Index column) {
    step.apply(state, next);
    value_.col(column) = next;
    step.tangent_by_unknowns(state, slopes, along);
    slope_.col(column) = along.reshaped();
  };
  step.set(form, {});
  for (Index i = 0; i < moving_; ++i) {
    state[i] = 1.0;
    keep(i);
    state[i] = 0.0;
  }
  MatrixXd chain = MatrixXd::Zero(form.inputs.cols(), powers);
  for (Index i = 0; i < chain.size(); ++i) {
    chain.reshaped()[i] = 1.0;
    step.set(form, chain);
    keep(moving_ + i);
    chain.reshaped()[i] = 0.0;
  }
}

void HeldStep::step(const VectorXd& state, const MatrixXd& chain, VectorXd& next,
                    Eigen::Ref<MatrixXd> tangent, Eigen::Ref<MatrixXd> by_unknowns) {
  joined_.head(moving_) = state.head(moving_);
  joined_.tail(chain.size()) = chain.reshaped();
  next.head(moving_).noalias() = value_ * joined_;
  tangent = value_.leftCols(moving_);
  sloped_.noalias() = slope_ * joined_;
  by_unknowns = sloped_.reshaped(moving_, by_unknowns.cols());
}

/// Linear in the states s (the unknowns apart) and in the inputs u at the instant:
///
///     y = G [s; u],   d y / d eta_j = G_j [s; u]
///
/// Made of one reading of each unit vector, as HeldStep is of steps.
class HeldReading {
 public:
  /// Readings of unit vectors that G and G_j take (columns); those of unknowns are zero.
  static Index columns(const SecondOrderMotion& motion) { return motion.layout().size + motion.input_size(); }

  HeldReading(const SecondOrderMotion& motion, const VectorXd& unknowns, const SecondOrderForm& form,
              const std::vector<SecondOrderForm>& slopes);

  void read(const VectorXd& state, const VectorXd& input, VectorXd& output) {
    join(state, input);
    output.noalias() = value_ * joined_;
  }
  /// @param jacobian (p x n), its columns of unknowns from `unknowns_` on
  void read_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) {
    join(state, input);
    sloped_.noalias() = slope_ * joined_;
    jacobian = constant_;
    jacobian.middleCols(unknowns_, count_) = sloped_.reshaped(constant_.rows(), count_);
  }

 private:
  void join(const VectorXd& state, const VectorXd& input) {
    joined_.head(state.size()) = state;
    const Index inputs = joined_.size() - state.size();
    if (input.size() > 0) joined_.tail(inputs) = input.head(inputs);
  }

  Index unknowns_, count_;
  MatrixXd value_, slope_, constant_;  // G (p x columns), G_j one below the other, what no state changes
  VectorXd joined_, sloped_;
};

HeldReading::HeldReading(const SecondOrderMotion& motion, const VectorXd& unknowns,
                         const SecondOrderForm& form, const std::vector<SecondOrderForm>& slopes)
    : unknowns_(motion.layout().unknowns), count_(static_cast<Index>(slopes.size())) {
  const Index size = motion.layout().size, all = columns(motion);
  joined_.setZero(all);
  VectorXd output;
  MatrixXd jacobian;
  const auto read_at = [&](VectorXd one) {
    one.segment(unknowns_, unknowns.size()) = unknowns;
    const VectorXd state = one.head(size), input = one.tail(all - size);
    motion.read(state, input, form, output);
    motion.read_jacobian(state, input, form, slopes, jacobian);
  };
  read_at(joined_);
  constant_ = jacobian;
  value_.setZero(output.size(), all);
  slope_.setZero(output.size() * count_, all);
  for (Index k = 0; k < all; ++k) {
    if (k >= unknowns_ && k < unknowns_ + count_) continue;
    read_at(VectorXd::Unit(all, k));
    value_.col(k) = output;
    slope_.col(k) = jacobian.middleCols(unknowns_, count_).reshaped();
  }
}

class SecondOrderStep final : public filters::TimedModel {
 public:
  SecondOrderStep(std::shared_ptr<const SecondOrderMotion> motion, double dt, const std::string& scheme,
                  filters::Noise noise)
      : TimedModel(dt, std::move(noise)),
        motion_(std::move(motion)),
        scheme_(scheme == "exponential" ? RationalStep::Scheme::exponential : RationalStep::Scheme::pade) {
    prepare();
  }

  std::vector<filters::Label> state_labels() const override { return motion_->state_labels(); }
  std::vector<filters::Label> output_labels() const override { return motion_->output_labels(); }

  void transition(const VectorXd& state, const VectorXd& input, VectorXd& next) override {
    step(state, input, next, nullptr);
  }
  void linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                             MatrixXd& jacobian) override {
    step(state, input, next, &jacobian);
  }
  // Below the rows of the motion the tangent is the identity.
  void move(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd& directions) override {
    step(state, input, next, &tangent_);
    const StateLayout& at = motion_->layout();
    const auto moving = tangent_.topRows(at.motion);
    if (entries_.take(moving))
      entries_.from_left(directions, moved_);
    else
      moved_.noalias() = moving * directions;
    directions.topRows(at.motion) = moved_;
  }
  void output(const VectorXd& state, const VectorXd& input, VectorXd& output) override {
    evaluate(state, false);
    if (reading_)
      reading_->read(state, input, output);
    else
      motion_->read(state, input, form_, output);
  }
  void output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) override {
    evaluate(state, true);
    if (!reading_ && is_worth_holding(++readings_, HeldReading::columns(*motion_), motion_->rows().rows()))
      reading_.emplace(*motion_, unknowns_, form_, slopes_);
    if (reading_)
      reading_->read_jacobian(state, input, jacobian);
    else
      motion_->read_jacobian(state, input, form_, slopes_, jacobian);
  }

 private:
  std::shared_ptr<const SecondOrderMotion> motion_;
  RationalStep::Scheme scheme_;
  bool apart_ = false;                    // oscillators in closed form
  std::optional<RationalStep> rational_;  // all coordinates together; absent where it is never needed
  // The equations at unknowns_, and what is known of them: a step and the outputs after it share them.
  VectorXd unknowns_, held_input_;
  bool has_form_ = false, has_slopes_ = false, is_set_ = false;
  Index tangents_ = 0, readings_ = 0;  // computed at these unknowns
  std::optional<HeldStep> held_;       // once as many as it costs
  std::optional<HeldReading> reading_;
  SecondOrderForm form_;
  std::vector<SecondOrderForm> slopes_;
  MatrixXd tangent_, moved_;
  filters::NonZeros entries_;  // of tangent_

  void interval_changed() override { prepare(); }
  void prepare() {
    is_set_ = false;
    forget_held();
    apart_ = scheme_ == RationalStep::Scheme::exponential && motion_->decoupled();
    if (!apart_ || motion_->input_size() > 0) rational_.emplace(scheme_, interval(), motion_->frequencies());
  }

  void forget_held() {
    tangents_ = readings_ = 0;
    held_.reset();
    reading_.reset();
  }

  // dt A of oscillator i, or its change along an unknown
  Matrix2d turn(const SecondOrderForm& form, Index i, double rate) const {
    Matrix2d z;
    z << 0.0, interval() * rate, -interval() * form.stiffness(i, i), -interval() * form.damping(i, i);
    return z;
  }

  // dt B p_j of oscillator i in columns; none without inputs
  filters::ForcedOscillator::Pushes pushes(const SecondOrderForm& form, Index i,
                                           const VectorXd& input) const {
    const Index m = form.inputs.cols(), count = m > 0 ? input.size() / m : 0;
    filters::ForcedOscillator::Pushes found(2, count);
    found.row(0).setZero();
    if (count > 0) found.row(1).noalias() = interval() * (form.inputs.row(i) * input.reshaped(m, count));
    return found;
  }

  bool moves_apart(const VectorXd& input) const {
    if (!apart_ || input.size() == 0) return apart_;
    for (Index i = 0; i < form_.stiffness.rows(); ++i)
      if (!filters::ForcedOscillator::takes(turn(form_, i, 1.0))) return false;
    return true;
  }

  void evaluate(const VectorXd& state, bool slopes) {
    const StateLayout& at = motion_->layout();
    const auto unknowns =
        state.segment(at.unknowns, static_cast<Index>(motion_->description().unknowns.size()));
    if (!has_form_ || unknowns != unknowns_) {
      has_form_ = has_slopes_ = is_set_ = false;
      forget_held();
      unknowns_ = unknowns;
    }
    if (has_slopes_ || (has_form_ && !slopes)) return;
    motion_->evaluate(state, form_, slopes ? &slopes_ : nullptr);
    has_form_ = true;
    has_slopes_ = slopes;
  }

  void step(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd* tangent) {
    const StateLayout& at = motion_->layout();
    evaluate(state, tangent != nullptr);
    next = state;
    if (tangent) tangent->setIdentity(at.size, at.size);
    for (std::size_t i = 0; i < at.drifts.size(); ++i) {
      if (at.drifts[i] < 0) continue;
      next[at.biases[i]] += interval() * state[at.drifts[i]];
      if (tangent) (*tangent)(at.biases[i], at.drifts[i]) = interval();
    }
    if (moves_apart(input))
      step_apart(state, input, next, tangent);
    else
      step_together(state, input, next, tangent);
  }

  void step_together(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd* tangent) {
    const MatrixXd chain = rational_->chain_of(input, form_.inputs.cols());
    const Index columns = HeldStep::columns(form_, chain.cols());
    if (tangent &&
        (held_ ? held_->takes(chain) : is_worth_holding(tangents_, columns, 2 * form_.stiffness.rows()))) {
      if (!held_) held_.emplace(*rational_, form_, slopes_, chain.cols()), is_set_ = false;
      held_->step(state, chain, next, by_motion(*tangent), by_unknowns(*tangent));
      return;
    }
    if (!is_set_ || held_input_.size() != input.size() || held_input_ != input) {
      rational_->set(form_, chain);
      held_input_ = input;
      is_set_ = true;
    }
    rational_->apply(state, next);
    if (!tangent) return;
    ++tangents_;
    rational_->tangent(by_motion(*tangent));
    rational_->tangent_by_unknowns(state, slopes_, by_unknowns(*tangent));
  }

  // Where the record is walked at one set of unknowns; a filter moves them with every sample.
  // @param times computed so far @param columns, rows of the matrix that is kept
  bool is_worth_holding(Index times, Index columns, Index rows) const {
    constexpr Index most_entries = 2'000'000;
    const Index q = static_cast<Index>(slopes_.size());
    return q > 0 && times >= columns && rows * q * columns <= most_entries;
  }

  Eigen::Block<MatrixXd> by_motion(MatrixXd& tangent) const {
    const Index moving = 2 * motion_->layout().coordinates;
    return tangent.topLeftCorner(moving, moving);
  }
  Eigen::Block<MatrixXd> by_unknowns(MatrixXd& tangent) const {
    const StateLayout& at = motion_->layout();
    return tangent.block(0, at.unknowns, 2 * at.coordinates, static_cast<Index>(slopes_.size()));
  }

  void step_apart(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd* tangent) {
    const StateLayout& at = motion_->layout();
    const Index r = at.coordinates;
    for (Index i = 0; i < r; ++i) {
      const Matrix2d z = turn(form_, i, 1.0);
      const filters::Exponential2x2 exponential(z);
      const Vector2d before(state[i], state[r + i]);
      Vector2d after = exponential.value() * before;
      const auto pushed = pushes(form_, i, input);
      std::optional<filters::ForcedOscillator> forced;
      if (pushed.cols() > 0) after += forced.emplace(z, exponential.value(), pushed).value();
      next[i] = after[0];
      next[r + i] = after[1];
      if (!tangent) continue;
      (*tangent)(i, i) = exponential.value()(0, 0);
      (*tangent)(i, r + i) = exponential.value()(0, 1);
      (*tangent)(r + i, i) = exponential.value()(1, 0);
      (*tangent)(r + i, r + i) = exponential.value()(1, 1);
      for (std::size_t j = 0; j < slopes_.size(); ++j) {
        const Matrix2d along = turn(slopes_[j], i, 0.0);
        const auto pushed_along = pushes(slopes_[j], i, input);
        if (along.isZero(0.0) && pushed_along.isZero(0.0)) continue;
        const Matrix2d slope = exponential.derivative(along);
        Vector2d moved = slope * before;
        if (forced) moved += forced->derivative(along, slope, pushed_along);
        (*tangent)(i, at.unknowns + static_cast<Index>(j)) = moved[0];
        (*tangent)(r + i, at.unknowns + static_cast<Index>(j)) = moved[1];
      }
    }
  }
};

}  // namespace

std::unique_ptr<filters::DiscreteModel> second_order_step(std::shared_ptr<const SecondOrderMotion> motion,
                                                          double dt, const std::string& scheme,
                                                          const filters::Noise& noise) {
  if (scheme != "exponential" && scheme != "pade") return nullptr;
  return std::make_unique<SecondOrderStep>(std::move(motion), dt, scheme, noise);
}

}  // namespace beamid::experiments
