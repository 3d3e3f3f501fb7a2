#include <weave/ranks/split_cloth.hpp>

#include <weave/sim/approach.hpp>
#include <weave/sim/relax.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

namespace weave::ranks {

namespace {

/// Runs of a block's moving points along their yarns, as rows.
std::vector<sim::YarnRows> runs_of(const Cut& cut, const Part& part) {
    std::vector<sim::YarnRows> runs;
    const Point* last = nullptr;
    std::uint32_t row = 0;
    for (const Point& point : part.own) {
        if (!cut.moves(point)) continue;
        const bool follows = last != nullptr && last->yarn == point.yarn && last->index + 1 == point.index;
        if (!follows) runs.push_back({row, 0, false});
        ++runs.back().rows;
        runs.back().is_closed = cut.yarns[point.yarn].is_periodic && runs.back().rows == cut.points[point.yarn];
        ++row;
        last = &point;
    }
    return runs;
}

sim::RowPlaces places_of(const Cut& cut, const Part& part) {
    sim::RowPlaces places;
    for (const Point& point : part.own) {
        if (cut.moves(point)) places.at.push_back({point.planned.x(), point.planned.y()});
    }
    return places;
}

/// The rows and columns of a piece's own points alone.
sim::BlockMatrix own_part(const Piece& piece) {
    std::vector<std::uint32_t> own_row(piece.matrix.rows(), Piece::none), rows;
    for (const std::uint32_t row : piece.row_of_own()) {
        if (row == Piece::none) continue;
        own_row[row] = static_cast<std::uint32_t>(rows.size());
        rows.push_back(row);
    }
    const auto each = [&](const auto& visit) {
        for (const std::uint32_t row : rows) {
            for (std::uint32_t at = piece.matrix.first(row); at < piece.matrix.first(row + 1); ++at) {
                if (own_row[piece.matrix.column(at)] != Piece::none) visit(own_row[row], own_row[piece.matrix.column(at)], at);
            }
        }
    };
    std::vector<std::uint32_t> first(rows.size() + 1, 0), columns;
    each([&](std::uint32_t row, std::uint32_t column, std::uint32_t) {
        ++first[row + 1];
        columns.push_back(column);
    });
    for (std::size_t row = 0; row < rows.size(); ++row) first[row + 1] += first[row];
    sim::BlockMatrix own;
    own.shape(std::move(first), std::move(columns));
    std::size_t next = 0;
    each([&](std::uint32_t, std::uint32_t, std::uint32_t at) { std::copy_n(piece.matrix.value(at), 9, own.value(next++)); });
    return own;
}

double length2(const std::vector<double>& slots, std::size_t at) {
    return slots[at] * slots[at] + slots[at + 1] * slots[at + 1] + slots[at + 2] * slots[at + 2];
}

}  // namespace

SplitCloth::SplitCloth(Comm& comm, const Cut& all, const std::vector<Part>& parts, const sim::Executor& executor, Slots& start)
    : state(start),
      m_comm(comm),
      m_cut(all),
      m_parts(parts),
      m_executor(executor),
      m_along(comm, all, parts, points_along(parts)),
      m_slots(parts.size()),
      m_coarse(comm, all, parts) {
    std::uint32_t point = 0;
    for (const Part& part : parts) {
        for (const Point& own : part.own) {
            if (all.moves(own)) m_point_of_row.push_back(point);
            ++point;
        }
        m_first_slot.push_back(3 * std::size_t(point));
        m_first_row.push_back(3 * m_point_of_row.size());
        m_multigrids.push_back(std::make_unique<sim::Multigrid>(executor, runs_of(all, part), places_of(all, part)));
    }
    for (std::size_t rank = 0; rank < comm.size(); ++rank) {
        const auto [first, last] = all.blocks_of(rank, comm.size());
        m_blocks_of_rank.push_back(last - first);
    }
    const std::vector<double> rows = comm.gather(static_cast<double>(m_point_of_row.size()));
    for (std::size_t rank = 0; rank < rows.size(); ++rank) {
        m_all_rows += static_cast<std::size_t>(rows[rank]);
        if (rank < comm.rank()) m_rows_before += static_cast<std::size_t>(rows[rank]);
    }
    lay_anew();
}

void SplitCloth::lay_anew() {
    m_lay = lay_out(m_comm, m_cut, m_parts, m_along, state, m_executor);
    for (const auto& piece : m_lay->pieces) piece->energy().give_beyond(m_give);
    m_laid = state;
    ++m_lays;
}

void SplitCloth::begin_anew() {
    m_give = std::numeric_limits<double>::infinity();
    m_pairs.forget();
    lay_anew();
}

std::span<const double> SplitCloth::of_block(const Slots& slots, std::size_t block) const {
    return std::span(slots).subspan(m_first_slot[block], m_first_slot[block + 1] - m_first_slot[block]);
}

/// The slots of each piece: its state, or m_slots where it is a change.
void SplitCloth::lay_slots(const Slots& own, bool is_state) {
    m_lay->exchange.run(own, m_guests);
    std::size_t at = 0;
    for (std::size_t b = 0; b < m_lay->pieces.size(); ++b) {
        Piece& piece = *m_lay->pieces[b];
        const std::span<const double> guests(m_guests.data() + at, 3 * piece.guests().size());
        if (is_state)
            piece.lay_state(of_block(own, b), guests, piece.state);
        else
            piece.lay_change(of_block(own, b), guests, m_slots[b]);
        at += guests.size();
    }
}

/// Energy of all blocks. Where a point has gone too far for what was laid out, it is laid out anew, and all is found again.
double SplitCloth::evaluate_into(Slots& forces) {
    ++m_evaluations;
    forces.resize(state.size());
    const double travel = travel_mm(m_cut);
    for (int attempt = 0;; ++attempt) {
        lay_slots(state, true);
        std::vector<double> told, all;
        for (std::size_t b = 0; b < m_lay->pieces.size(); ++b) {
            Piece& piece = *m_lay->pieces[b];
            told.push_back(piece.energy().evaluate(piece.state, m_slots[b]));
            piece.take(m_slots[b], std::span(forces).subspan(m_first_slot[b], m_first_slot[b + 1] - m_first_slot[b]));
            double gone2 = 0;
            for (std::size_t at = m_first_slot[b]; at < m_first_slot[b + 1]; at += 3) {
                double gone = 0;
                for (std::size_t k = at; k < at + 3; ++k) gone += (state[k] - m_laid[k]) * (state[k] - m_laid[k]);
                gone2 = std::max(gone2, gone);
            }
            told.push_back(gone2);
        }
        std::vector<std::size_t> counts;
        for (const std::size_t blocks : m_blocks_of_rank) counts.push_back(2 * blocks);
        m_comm.gather(told, counts, all);
        double energy = 0, gone2 = 0;
        for (std::size_t at = 0; at < all.size(); at += 2) {
            energy += all[at];
            gone2 = std::max(gone2, all[at + 1]);
        }
        if (attempt > 0 || !(gone2 > travel * travel)) return energy;
        lay_anew();
    }
}

double SplitCloth::go(double share) {
    for (std::size_t i = 0; i < state.size(); ++i) state[i] = before[i] + share * change[i];
    return evaluate_trial();
}

void SplitCloth::give_beyond(double strain) {
    m_give = strain;
    for (const auto& piece : m_lay->pieces) piece->energy().give_beyond(strain);
}

void SplitCloth::contact_forces(Slots& forces) {
    forces.resize(state.size());
    lay_slots(state, true);
    for (std::size_t b = 0; b < m_lay->pieces.size(); ++b) {
        Piece& piece = *m_lay->pieces[b];
        piece.energy().evaluate(piece.state, m_slots[b], {.elastic = false, .contact = true});
        piece.take(m_slots[b], std::span(forces).subspan(m_first_slot[b], m_first_slot[b + 1] - m_first_slot[b]));
    }
}

double SplitCloth::reference_force() {
    double reference = 0;
    sim::SimScene yarns;
    yarns.yarns = m_cut.yarns;
    reference = sim::force_of_yarns(yarns);
    contact_forces(m_work);
    std::vector<double> touching;
    for (std::size_t at = 0; at < m_work.size(); at += 3) {
        const double force = std::sqrt(length2(m_work, at));
        if (force > 0) touching.push_back(force);
    }
    return std::max(reference, median_of_all(touching));
}

/// The middle of all ranks' numbers, none below 0, found digit by digit of their bits; 0 if there are none.
double SplitCloth::median_of_all(const std::vector<double>& own) const {
    constexpr int bits = 8;
    constexpr std::size_t digits = std::size_t{1} << bits;
    std::uint64_t found = 0;
    std::size_t left = 0;  // before the one that is looked for
    for (int shift = 64 - bits; shift >= 0; shift -= bits) {
        std::vector<double> counts(digits, 0), all;
        for (const double number : own) {
            const auto pattern = std::bit_cast<std::uint64_t>(number);
            const bool matches = shift + bits == 64 || pattern >> (shift + bits) == found >> (shift + bits);
            if (matches) counts[pattern >> shift & (digits - 1)] += 1;
        }
        m_comm.gather(counts, std::vector<std::size_t>(m_comm.size(), digits), all);
        std::vector<std::size_t> sum(digits, 0);
        for (std::size_t k = 0; k < all.size(); ++k) sum[k % digits] += static_cast<std::size_t>(all[k]);
        if (shift == 64 - bits) {
            for (const std::size_t count : sum) left += count;
            if (left == 0) return 0;
            left /= 2;
        }
        std::uint64_t digit = 0;
        while (digit + 1 < digits && left >= sum[digit]) left -= sum[digit++];
        found |= digit << shift;
    }
    return std::bit_cast<double>(found);
}

double SplitCloth::greatest_of_all(double own) const {
    double greatest = 0;
    for (const double number : m_comm.gather(own)) greatest = std::max(greatest, number);
    return greatest;
}

double SplitCloth::dot(const std::vector<double>& a, const std::vector<double>& b) const {
    const std::vector<std::size_t>& first = a.size() == m_first_slot.back() ? m_first_slot : m_first_row;
    std::vector<double> told, all;
    for (std::size_t block = 0; block + 1 < first.size(); ++block)
        told.push_back(m_executor.sum(first[block + 1] - first[block], [&](std::size_t i) { return a[first[block] + i] * b[first[block] + i]; }));
    m_comm.gather(told, m_blocks_of_rank, all);
    double sum = 0;
    for (const double part : all) sum += part;
    return sum;
}

double SplitCloth::greatest_force(const Slots& slots) const {
    return std::sqrt(greatest_of_all(m_executor.greatest(slots.size() / 3, [&](std::size_t i) { return length2(slots, 3 * i); })));
}

double SplitCloth::safe_share(const Slots& slots, double most) {
    lay_slots(slots, false);
    double share = most;
    for (std::size_t b = 0; b < m_lay->pieces.size(); ++b) {
        Piece& piece = *m_lay->pieces[b];
        share = std::min(share, piece.energy().safe_share(piece.state, m_slots[b], most));
    }
    for (const double other : m_comm.gather(share)) share = std::min(share, other);
    return share;
}

void SplitCloth::shorten(Slots& slots) {
    using Rounds = sim::ShorteningRounds;
    std::vector<std::vector<double>> shares(m_lay->pieces.size());
    for (int round = 0; round < Rounds::most; ++round) {
        lay_slots(slots, false);
        double unsafe = 0;
        for (std::size_t b = 0; b < shares.size(); ++b) {
            Piece& piece = *m_lay->pieces[b];
            if (!piece.energy().find_safe_shares(piece.state, m_slots[b], shares[b])) unsafe = 1;
        }
        if (greatest_of_all(unsafe) == 0) return;
        for (std::size_t b = 0; b < shares.size(); ++b) {
            Piece& piece = *m_lay->pieces[b];
            piece.energy().shorten_by(piece.state, shares[b], round, m_slots[b]);
            piece.take(m_slots[b], std::span(slots).subspan(m_first_slot[b], m_first_slot[b + 1] - m_first_slot[b]));
        }
    }
    const double whole = safe_share(slots, 1);
    if (whole < Rounds::enough) scale(slots, whole);
}

void SplitCloth::stop_uphill(Slots& slots) const {
    for (std::size_t i = 0; i + 2 < slots.size(); i += 3) {
        if (gradient[i] * slots[i] + gradient[i + 1] * slots[i + 1] + gradient[i + 2] * slots[i + 2] > 0)
            slots[i] = slots[i + 1] = slots[i + 2] = 0;
    }
}

void SplitCloth::scale(Slots& slots, double share) const {
    for (double& part : slots) part *= share;
}

void SplitCloth::assemble(sim::Curvature curvature) {
    m_matrix_lay = m_lay;
    for (const auto& piece : m_lay->pieces) piece->hessian().assemble(piece->energy(), piece->state, curvature, piece->matrix);
}

void SplitCloth::add_to_pivots(float share) {
    for (const auto& piece : m_matrix_lay->pieces) piece->matrix.add_to_pivots(share);
}

void SplitCloth::factor() {
    for (std::size_t b = 0; b < m_multigrids.size(); ++b) m_multigrids[b]->factor(own_part(*m_matrix_lay->pieces[b]));
    m_coarse.factor(m_matrix_lay->pieces, m_parts);
}

void SplitCloth::apply_preconditioner(const Rows& of, Rows& result) {
    result.resize(of.size());
    std::vector<double> residual_of_block, found;
    for (std::size_t b = 0; b < m_multigrids.size(); ++b) {
        residual_of_block.assign(of.begin() + static_cast<std::ptrdiff_t>(m_first_row[b]), of.begin() + static_cast<std::ptrdiff_t>(m_first_row[b + 1]));
        m_multigrids[b]->apply(residual_of_block, found);
        std::ranges::copy(found, result.begin() + static_cast<std::ptrdiff_t>(m_first_row[b]));
    }
    m_coarse.apply(of, result);
}

void SplitCloth::to_rows(const Slots& slots, Rows& rows) const {
    rows.resize(3 * m_point_of_row.size());
    for (std::size_t row = 0; row < m_point_of_row.size(); ++row) {
        for (std::size_t k = 0; k < 3; ++k) rows[3 * row + k] = slots[3 * std::size_t(m_point_of_row[row]) + k];
    }
}

void SplitCloth::change_from(const Rows& rows) {
    change.assign(state.size(), 0);
    for (std::size_t row = 0; row < m_point_of_row.size(); ++row) {
        for (std::size_t k = 0; k < 3; ++k) change[3 * std::size_t(m_point_of_row[row]) + k] = rows[3 * row + k];
    }
}

void SplitCloth::find_direction() {
    to_rows(gradient, m_work);
    m_pairs.find_direction(
        m_executor, m_work, direction, [this](const Rows& a, const Rows& b) { return dot(a, b); },
        [this](const Rows& of, Rows& result) { apply_preconditioner(of, result); });
    change_from(direction);
}

void SplitCloth::remember(double share) {
    sim::LearnedPairs::Pair pair;
    to_rows(change, pair.change);
    for (double& part : pair.change) part *= share;
    to_rows(trial, pair.bend);
    to_rows(gradient, m_work);
    for (std::size_t i = 0; i < m_work.size(); ++i) pair.bend[i] -= m_work[i];
    m_pairs.remember(std::move(pair), m_work, [this](const Rows& a, const Rows& b) { return dot(a, b); });
}

void SplitCloth::start_from_gradient() {
    to_rows(gradient, residual);
    for (double& force : residual) force = -force;
    step.assign(residual.size(), 0);
}

void SplitCloth::start_at_random() {
    residual.resize(3 * m_point_of_row.size());
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = sim::some_number(3 * m_rows_before + i);
    step.assign(residual.size(), 0);
}

double SplitCloth::precondition() {
    apply_preconditioner(residual, solved);
    return dot(residual, solved);
}

void SplitCloth::turn(double share) {
    if (share == 0) {
        direction = solved;
        return;
    }
    m_executor.each(solved.size(), [&](std::size_t i) { direction[i] = solved[i] + share * direction[i]; });
}

double SplitCloth::curvature() {
    Slots by_point(state.size(), 0);
    for (std::size_t row = 0; row < m_point_of_row.size(); ++row) {
        for (std::size_t k = 0; k < 3; ++k) by_point[3 * std::size_t(m_point_of_row[row]) + k] = direction[3 * row + k];
    }
    m_matrix_lay->exchange.run(by_point, m_guests);
    product.resize(direction.size());
    std::size_t guest = 0;
    for (std::size_t b = 0; b < m_matrix_lay->pieces.size(); ++b) {
        const Piece& piece = *m_matrix_lay->pieces[b];
        m_local.assign(3 * piece.matrix.rows(), 0);
        const auto lay = [&](const std::vector<std::uint32_t>& rows, const double* from) {
            for (std::size_t i = 0; i < rows.size(); ++i) {
                if (rows[i] != Piece::none) std::copy_n(from + 3 * i, 3, &m_local[3 * std::size_t(rows[i])]);
            }
        };
        lay(piece.row_of_own(), by_point.data() + m_first_slot[b]);
        lay(piece.row_of_guest(), m_guests.data() + guest);
        guest += 3 * piece.guests().size();
        piece.matrix.multiply(m_executor, m_local, m_local_product);
        std::size_t at = m_first_row[b];
        for (const std::uint32_t row : piece.row_of_own()) {
            if (row == Piece::none) continue;
            std::copy_n(&m_local_product[3 * std::size_t(row)], 3, &product[at]);
            at += 3;
        }
    }
    return dot(direction, product);
}

void SplitCloth::move(double share) {
    m_executor.each(step.size(), [&](std::size_t i) {
        step[i] += share * direction[i];
        residual[i] -= share * product[i];
    });
}

std::vector<double> SplitCloth::lengths() {
    lay_slots(state, true);
    std::vector<double> told;
    for (const auto& piece : m_lay->pieces) {
        const sim::Fabric<double>& fabric = piece->fabric();
        std::map<std::uint32_t, double> of_yarn;
        for (std::size_t s = 0; s < fabric.segments(); ++s) {
            const sim::SegmentPlace& segment = fabric.segment_places()[s];
            if (!fabric.is_own(s)) continue;
            of_yarn[piece->strands()[segment.yarn].yarn] += sim::Speeds<double>(fabric.gauss(), &piece->state[3 * std::size_t(segment.slot)]).length;
        }
        for (const auto& [yarn, length] : of_yarn) told.insert(told.end(), {static_cast<double>(yarn), length});
    }
    std::vector<double> whole(m_cut.yarns.size(), 0);
    for (const Comm::Packet& packet : m_comm.gather(told)) {
        for (std::size_t at = 0; at < packet.size(); at += 2) whole[static_cast<std::size_t>(packet[at])] += packet[at + 1];
    }
    return whole;
}

double SplitCloth::greatest_strain() {
    const std::vector<double> whole = lengths();
    double greatest = 0;
    for (std::size_t y = 0; y < whole.size(); ++y) {
        if (!m_cut.yarns[y].is_fed && m_cut.yarns[y].rest_mm > 0) greatest = std::max(greatest, whole[y] / m_cut.yarns[y].rest_mm - 1);
    }
    return greatest;
}

}  // namespace weave::ranks
