#pragma once

#include <weave/ranks/coarse.hpp>
#include <weave/ranks/lay.hpp>
#include <weave/sim/cloth.hpp>
#include <weave/sim/learned_pairs.hpp>
#include <weave/sim/multigrid.hpp>

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace weave::ranks {

/// A cloth that the steps of a relaxation lead on several ranks at once; what each operation means: sim/cloth.hpp. A vector here
/// holds what belongs to the blocks of this rank, block after block: three numbers for each point (slots), or for each that
/// moves (rows). Numbers of points elsewhere are brought when they are needed. Every number that decides something is formed
/// block by block and joined in the order of blocks, so all ranks get the same, however many they are.
class SplitCloth {
  public:
    using Slots = std::vector<double>;
    using Rows = std::vector<double>;

    /// `start`: where this rank's points lie; becomes the state, where it lies. Called, as all else here, by all ranks at once.
    SplitCloth(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const sim::Executor& executor, Slots& start);

    static constexpr double noise = 1e-12;
    static constexpr bool lacks_room() { return false; }
    [[nodiscard]] bool is_empty() const { return m_all_rows == 0; }
    [[nodiscard]] double least_reach() const { return 2 * m_cut.terms.least_radius_mm; }

    double reference_force();
    void give_beyond(double strain);
    double evaluate() { return evaluate_into(gradient); }
    double evaluate_trial() { return evaluate_into(trial); }
    double go(double share);
    void keep_state() { before = state; }
    void back() { state = before; }
    void accept_trial() { gradient.swap(trial); }

    [[nodiscard]] double dot(const std::vector<double>& a, const std::vector<double>& b) const;
    [[nodiscard]] double greatest_force(const Slots& slots) const;
    double safe_share(const Slots& slots, double most);
    void shorten(Slots& slots);
    void stop_uphill(Slots& slots) const;
    void scale(Slots& slots, double share) const;
    void cut_from_change() { cut = change; }
    void accept_cut() { change.swap(cut); }

    void assemble(sim::Curvature curvature);
    void add_to_pivots(float share);
    void factor();

    void find_direction();
    void remember(double share);
    void forget_pairs() { m_pairs.forget(); }

    void start_from_gradient();
    void start_at_random();
    double precondition();
    void turn(double share);
    double curvature();
    void move(double share);
    void change_from(const Rows& rows);
    void aim_along_change() { to_rows(change, direction); }

    Slots& state;
    Slots gradient, trial, before, change, cut;
    Rows residual, solved, direction, step, product;

    /// Forgets all that earlier states have left: what follows has the same bits as if it began here.
    void begin_anew();
    /// Length of each yarn of the cloth at the state, mm.
    std::vector<double> lengths();
    /// Greatest strain of yarns of fixed length at the state, each taken as a whole.
    double greatest_strain();
    /// The pieces as they were evaluated last, one for each block of this rank.
    [[nodiscard]] const std::vector<std::unique_ptr<Piece>>& pieces() const { return m_lay->pieces; }
    /// Where each block's points begin in a vector of slots, and the last ends.
    [[nodiscard]] const std::vector<std::size_t>& first_slots() const { return m_first_slot; }
    [[nodiscard]] std::size_t evaluations() const { return m_evaluations; }
    [[nodiscard]] std::size_t lays() const { return m_lays; }
    /// Contact force on each own point at the state: three numbers each.
    void contact_forces(Slots& forces);

  private:
    double evaluate_into(Slots& forces);
    void lay_anew();
    void lay_slots(const Slots& own, bool is_state);
    void apply_preconditioner(const Rows& of, Rows& result);
    void to_rows(const Slots& slots, Rows& rows) const;
    [[nodiscard]] std::span<const double> of_block(const Slots& slots, std::size_t block) const;
    [[nodiscard]] double greatest_of_all(double own) const;
    [[nodiscard]] double median_of_all(const std::vector<double>& own) const;

    Comm& m_comm;
    const Cut& m_cut;
    const std::vector<Part>& m_parts;
    const sim::Executor& m_executor;
    Exchange m_along;
    std::shared_ptr<Lay> m_lay, m_matrix_lay;  ///< as yarns lie now, and as they did when the matrix was assembled
    std::vector<std::vector<double>> m_slots;  ///< scratch: of each piece
    std::vector<double> m_guests, m_local, m_local_product;
    Slots m_laid;  ///< where points were when the lay was made
    CoarseGrid m_coarse;
    std::vector<std::unique_ptr<sim::Multigrid>> m_multigrids;
    sim::LearnedPairs m_pairs;
    std::vector<std::size_t> m_first_slot{0}, m_first_row{0};  ///< of each block, and the end
    std::vector<std::uint32_t> m_point_of_row;
    std::vector<std::size_t> m_blocks_of_rank;
    std::size_t m_rows_before = 0, m_all_rows = 0;  ///< rows of the blocks before those of this rank, and of all
    double m_give = std::numeric_limits<double>::infinity();
    Rows m_work;
    std::size_t m_evaluations = 0, m_lays = 0;
};

}  // namespace weave::ranks
