#pragma once

#include <weave/sim/cloth.hpp>
#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/curvature.hpp>
#include <weave/sim/device/forces.hpp>
#include <weave/sim/device/lists.hpp>
#include <weave/sim/device/pairs.hpp>
#include <weave/sim/device/pieces_apply.hpp>
#include <weave/sim/device/rows.hpp>
#include <weave/sim/device/safe.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// The arrays that a crew relaxes a cloth in.
template <class Real>
struct CrewRoom {
    ClothView<Real> cloth;
    ListsRoom<Real> lists;
    ForcesRoom<Real> forces;
    CurvatureView<Real> curvature;
    PiecesView<Real> pieces;
    PairsRoom<Real> pairs;
    View<Moved<Real>> moved;      ///< per own sample
    View<double> share;           ///< per segment
    View<double> state, before;   ///< 3 numbers a slot
    View<Real> gradient, trial, change, cut, residual, solved, direction, step, product;  ///< 3 numbers a row
    View<std::uint32_t> key;      ///< per row
    double reference_floor_N = 0; ///< the reference force without contact
};

/// What there is too little room for.
enum class Lacking : std::uint8_t { nothing, lists, curvature, pieces };

/// A strain that no yarn comes to, in float as well: StretchLaw::give where nothing gives way.
inline constexpr double unlimited_give = 1e30;

/// Numbers that a crew's cloth goes on with.
struct CrewState {
    ListsState lists;
    Lacking lacking = Lacking::nothing;
    std::uint32_t shape_of_build = 0;  ///< which lists the matrix has the shape of, by ListsState::builds; 0: none
    bool are_pieces_shaped = false;    ///< for this shape
    std::uint32_t pairs = 0, newest_pair = 0;
    double give = unlimited_give;
    /// What evaluating and solving cost so far.
    std::uint64_t evaluations = 0;
    bool is_traded = false;  ///< gradient and trial have changed places
};

/// The cloth of a crew, as steps ask for it (cloth.hpp). Its slots' vectors hold 3 numbers for each point that moves, as its rows
/// do; those that follow are placed where a state is made.
template <class Real, class Crew>
class CrewCloth {
  public:
    /// Energies are sums of segments' in Real.
    static constexpr double noise = std::is_same_v<Real, float> ? 1e-6 : 1e-12;

    WEAVE_ANYWHERE WEAVE_HD CrewCloth(Crew& crew, const CrewRoom<Real>& room, const CrewState& state)
        : gradient(state.is_traded ? room.trial : room.gradient), trial(state.is_traded ? room.gradient : room.trial), change(room.change),
          cut(room.cut), direction(room.direction), step(room.step), m_crew(crew), m_room(room), m_state(state),
          m_lists(room.cloth, room.lists, state.lists), m_pairs(room.pairs, state.pairs, state.newest_pair) {
        m_state.lacking = Lacking::nothing;
    }

    /// What another kernel can go on from.
    [[nodiscard]] WEAVE_HD CrewState state() const {
        CrewState state = m_state;
        state.lists = m_lists.state();
        state.pairs = m_pairs.count();
        state.newest_pair = m_pairs.newest();
        return state;
    }

    View<Real> gradient, trial, change, cut, direction, step;

    [[nodiscard]] WEAVE_HD bool lacks_room() const { return m_state.lacking != Lacking::nothing; }
    [[nodiscard]] WEAVE_HD bool is_empty() const { return m_room.cloth.rows == 0; }
    [[nodiscard]] WEAVE_HD double least_reach() const { return m_room.cloth.least_reach_mm; }

    // ---- Energy ----

    WEAVE_ANYWHERE WEAVE_HD double evaluate() { return evaluate_into(gradient, {}); }
    WEAVE_ANYWHERE WEAVE_HD double evaluate_trial() { return evaluate_into(trial, {}); }
    WEAVE_HD void give_beyond(double strain) { m_state.give = lesser(strain, unlimited_give); }

    WEAVE_ANYWHERE WEAVE_HD double go(double share) {
        m_crew.each(m_room.cloth.slots, GoAlong<Real>{m_room.cloth, m_room.before, change, share, m_room.state});
        return evaluate_trial();
    }
    WEAVE_ANYWHERE WEAVE_HD void keep_state() { m_crew.each(3 * std::size_t(m_room.cloth.slots), Copy<double>{m_room.state, m_room.before}); }
    WEAVE_ANYWHERE WEAVE_HD void back() { m_crew.each(3 * std::size_t(m_room.cloth.slots), Copy<double>{m_room.before, m_room.state}); }
    WEAVE_HD void accept_trial() {
        const View<Real> accepted = trial;
        trial = gradient;
        gradient = accepted;
        m_state.is_traded = !m_state.is_traded;
    }

    /// The greatest of warp tension, EI/L² and 1e-6·EA, and the median of the contact forces on points that are touched, found by halving
    /// what their lengths may be.
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD double reference_force() {
        evaluate_into(trial, {.elastic = false, .contact = true});
        if (lacks_room()) return 0;
        m_crew.each(m_room.cloth.rows, ForceKey<Real>{trial, m_room.key});
        std::uint32_t low = 1, high = 0x7f800000U;  // the keys of all lengths
        const double touched = m_crew.sum(m_room.cloth.rows, KeyUpTo{m_room.key, high});
        if (touched == 0) return m_room.reference_floor_N;
        const double middle = floor(touched / 2);
        while (low < high) {
            const std::uint32_t key = low + (high - low) / 2;
            if (m_crew.sum(m_room.cloth.rows, KeyUpTo{m_room.key, key}) > middle) high = key;
            else low = key + 1;
        }
        return greater(m_room.reference_floor_N, length_of(low));
    }

    // ---- Vectors ----

    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD double dot(const View<Real>& a, const View<Real>& b) { return m_crew.sum(numbers(), Dot<Real>{a, b}); }
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD double greatest_force(const View<Real>& of) { return sqrt(m_crew.greatest(m_room.cloth.rows, Length2<Real>{of})); }
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD double safe_share(const View<Real>& of, double most) {
        return safe().safe_share(m_crew, m_lists.view(), m_room.state, of, most);
    }
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD void shorten(const View<Real>& of) { safe().shorten(m_crew, m_lists.view(), m_room.state, of); }
    WEAVE_ANYWHERE WEAVE_HD void stop_uphill(const View<Real>& of) { m_crew.each(m_room.cloth.rows, StopUphill<Real>{gradient, of}); }
    WEAVE_ANYWHERE WEAVE_HD void scale(const View<Real>& of, double share) { m_crew.each(numbers(), Scale<Real>{static_cast<Real>(share), of}); }
    WEAVE_ANYWHERE WEAVE_HD void cut_from_change() { m_crew.each(numbers(), Copy<Real>{change, cut}); }
    WEAVE_ANYWHERE WEAVE_HD void accept_cut() { m_crew.each(numbers(), Copy<Real>{cut, change}); }
    WEAVE_ANYWHERE WEAVE_HD void change_from(const View<Real>& rows) { m_crew.each(numbers(), Copy<Real>{rows, change}); }
    WEAVE_ANYWHERE WEAVE_HD void aim_along_change() { m_crew.each(numbers(), Copy<Real>{change, direction}); }

    // ---- Matrix ----

    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD void assemble(Curvature curvature) {
        if (m_state.shape_of_build != m_lists.state().builds) {
            m_state.are_pieces_shaped = false;
            if (lacks(!make_shape(m_crew, m_room.cloth, m_lists.view(), m_room.curvature), Lacking::curvature)) return;
            m_state.shape_of_build = m_lists.state().builds;
        }
        sim::assemble(m_crew, m_room.cloth, m_lists.view(), m_room.state,
                      CurvatureLaw<Real>{curvature == Curvature::convex, static_cast<Real>(m_state.give)}, m_room.curvature);
    }
    WEAVE_ANYWHERE WEAVE_HD void add_to_pivots(float share) { sim::add_to_pivots(m_crew, m_room.curvature.matrix, share); }
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD void factor() {
        if (!m_state.are_pieces_shaped &&
            lacks(!shape_pieces(m_crew, m_room.curvature.matrix, m_room.pieces), Lacking::pieces))
            return;
        m_state.are_pieces_shaped = true;
        sim::factor(m_crew, m_room.curvature.matrix, m_room.pieces);
    }
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD void find_direction() {
        Apply apply{*this};
        m_pairs.find_direction(m_crew, gradient, apply, m_room.residual, m_room.solved, change);
    }
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD void remember(double share) { m_pairs.remember(m_crew, static_cast<Real>(share), change, gradient, trial); }
    WEAVE_HD void forget_pairs() { m_pairs.forget(); }

    // ---- Conjugate gradients ----

    WEAVE_ANYWHERE WEAVE_HD void start_from_gradient() { m_crew.each(numbers(), StartDownhill<Real>{gradient, step, m_room.residual}); }
    WEAVE_ANYWHERE WEAVE_HD void start_at_random() { m_crew.each(numbers(), StartAnyhow<Real>{step, m_room.residual}); }
    WEAVE_ANYWHERE WEAVE_HD double precondition() {
        Apply{*this}(m_room.residual, m_room.solved);
        return dot(m_room.residual, m_room.solved);
    }
    WEAVE_ANYWHERE WEAVE_HD void turn(double share) {
        if (share == 0) m_crew.each(numbers(), Copy<Real>{m_room.solved, direction});
        else m_crew.each(numbers(), AddScaled<Real>{static_cast<Real>(share), direction, m_room.solved, direction});
    }
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD double curvature() {
        multiply(m_crew, m_room.curvature.matrix, View<const Real>(direction), m_room.product);
        return dot(direction, m_room.product);
    }
    WEAVE_ANYWHERE WEAVE_HD void move(double share) {
        m_crew.each(numbers(), MoveAlong<Real>{static_cast<Real>(share), direction, m_room.product, step, m_room.residual});
    }

  private:
    struct Apply {
        CrewCloth& cloth;
        WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD void operator()(const View<const Real>& residual, const View<Real>& solved) {
            apply(cloth.m_crew, cloth.m_room.pieces, residual, solved);
        }
    };

    [[nodiscard]] WEAVE_HD std::size_t numbers() const { return 3 * std::size_t(m_room.cloth.rows); }
    [[nodiscard]] WEAVE_HD SafeSteps<Real> safe() const { return {m_room.cloth, m_room.moved, m_room.share}; }

    WEAVE_HD bool lacks(bool does, Lacking what) {
        m_state.lacking = does ? what : Lacking::nothing;
        return does;
    }

    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD double evaluate_into(const View<Real>& into, Terms terms) {
        ++m_state.evaluations;
        if (lacks(!m_lists.update(m_crew, m_room.state), Lacking::lists)) return 0;
        return pull(m_crew, m_room.cloth, m_lists.view(), m_room.forces, m_room.state, static_cast<Real>(m_state.give), terms, into);
    }

    Crew& m_crew;
    CrewRoom<Real> m_room;
    CrewState m_state;
    Lists<Real> m_lists;
    Pairs<Real> m_pairs;
};

}  // namespace weave::sim
