#pragma once

#include <weave/sim/approach.hpp>
#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/lists.hpp>
#include <weave/sim/device/rows.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// How a sample moves where rows move.
template <class Real>
struct alignas(4 * sizeof(Real)) Moved {
    Real by[3];
    Real unused;
};

/// How far each own sample moves with a change of the rows.
template <class Real>
struct MoveSamples {
    ClothView<Real> cloth;
    View<const Real> change;
    View<Moved<Real>> moved;

    WEAVE_HD void operator()(std::size_t index) const {
        const SegmentPlace segment = cloth.segment[cloth.segment_of_sample[index]];
        const Basis<Real>& basis = cloth.basis[cloth.yarn[segment.yarn].basis + (index - segment.sample)];
        Vec<Real> sum = Vec<Real>::Zero();
        for (std::uint32_t c = 0; c < 4; ++c) sum += basis.value[c] * movement_of(cloth, change, segment.slot + c);
        moved[index] = {{sum[0], sum[1], sum[2]}, 0};
    }
};

/// The share of a change that one sample may go: no near one comes closer by 0.45 of its distance, and none moves by a quarter
/// of the least reach. Squares alone, so that the loop over neighbours has neither roots nor divisions.
template <class Real>
struct SafeShare {
    ClothView<Real> cloth;
    ListsView<Real> lists;
    View<const double> state;
    View<const Moved<Real>> moved;
    double most;

    WEAVE_HD double operator()(std::size_t index) const {
        const Sample<Real> at = lists.sample[index];
        const Real radius = lists.radius[index];
        const Vec<Real> mine = load(moved[index].by);
        const auto far = static_cast<double>(mine.norm());
        const double alone = cloth.least_reach_mm / 4 / (far > 1e-300 ? far : 1e-300);
        double share = alone < most ? alone : most;
        Real change2 = 0, apart2 = 1;  // of the pair that allows least
        for (std::uint32_t e = lists.first[index]; e < lists.first[index + 1]; ++e) {
            const std::uint32_t b = lists.neighbour[e], own = lists.own_of(b);
            const Vec<Real> from = apart(at, lists.sample[b], static_cast<Real>(cloth.scale.step_mm)), change = mine - load(moved[own].by);
            const Real near2 = from.squaredNorm(), closing2 = change.squaredNorm(), reach = radius + lists.radius[b];
            if (near2 < reach * reach / 4) {
                const double crossing = lines(index, own, from, reach).share(change, reach);
                share = crossing < share ? crossing : share;
            }
            if (closing2 * apart2 <= change2 * near2) continue;
            change2 = closing2;
            apart2 = near2;
        }
        if (!(change2 > 0)) return share;
        const double near = closest * sqrt(static_cast<double>(apart2) / static_cast<double>(change2));
        return near < share ? near : share;
    }

    /// What of `mine`, the change of a slot that sample `index` follows, does not bring that one nearer to any it is pressed against.
    WEAVE_HD Vec<Real> without_closing(std::size_t index, Vec<Real> mine) const {
        const Sample<Real> at = lists.sample[index];
        const Real radius = lists.radius[index];
        const Vec<Real> move = load(moved[index].by);
        for (std::uint32_t e = lists.first[index]; e < lists.first[index + 1]; ++e) {
            const std::uint32_t b = lists.neighbour[e], own = lists.own_of(b);
            const Vec<Real> from = apart(at, lists.sample[b], static_cast<Real>(cloth.scale.step_mm)), theirs = load(moved[own].by);
            const Real reach = radius + lists.radius[b];
            if (from.squaredNorm() >= reach * reach / 4) continue;
            const CrossingLines<Real> both = lines(index, own, from, reach);
            if (both.is_pressed(reach) && both.closing(move - theirs) > 0) mine = both.without_closing(mine, move, theirs);
        }
        return mine;
    }

  private:
    WEAVE_HD CrossingLines<Real> lines(std::size_t index, std::size_t own, const Vec<Real>& from, Real reach) const {
        const SegmentPlace &mine = cloth.segment[cloth.segment_of_sample[index]], &other = cloth.segment[cloth.segment_of_sample[own]];
        return CrossingLines<Real>::of(tangent(index, mine), tangent(own, other), from, reach, mine.yarn == other.yarn);
    }

    WEAVE_HD Vec<Real> tangent(std::size_t index, const SegmentPlace& segment) const {
        Real slots[12];
        load_around_first(state, segment.slot, slots);
        return combine(cloth.basis[cloth.yarn[segment.yarn].basis + (index - segment.sample)].slope, slots);
    }
};

/// The same for all samples of one segment.
template <class Real>
struct SafeShareOfSegment {
    SafeShare<Real> of_sample;
    View<double> share;

    WEAVE_HD void operator()(std::size_t segment) const {
        const SegmentPlace& place = of_sample.cloth.segment[segment];
        double least = 1;
        for (std::uint32_t k = 0; k < of_sample.cloth.yarn[place.yarn].samples; ++k) {
            const double of = of_sample(place.sample + k);
            least = of < least ? of : least;
        }
        share[segment] = least;
    }
};

/// Leaves out of a row's change what would bring samples nearer that are pressed together, of segments that may not move. Slots beyond a
/// yarn's end that move as the row does count too.
template <class Real>
struct LeaveOutClosing {
    SafeShare<Real> of_sample;
    View<const double> share;
    View<Real> change;

    WEAVE_HD void operator()(std::size_t row) const {
        const ClothView<Real>& cloth = of_sample.cloth;
        const YarnSpan& span = cloth.span[cloth.yarn_of_row[row]];
        Vec<Real> mine = load(change.at(3 * row, 3));
        for (std::uint32_t i = cloth.first_slot_of_row[row]; i < cloth.first_slot_of_row[row + 1]; ++i) {
            if (cloth.slots_of_row[i].weight != 1) continue;
            const std::uint32_t within = cloth.slots_of_row[i].slot - span.first_slot;
            for (std::uint32_t c = 0; c < 4 && c <= within; ++c) {
                if (within - c >= span.segments || share[span.first_segment + within - c] > 0) continue;
                const SegmentPlace& place = cloth.segment[span.first_segment + within - c];
                for (std::uint32_t k = 0; k < cloth.yarn[place.yarn].samples; ++k) mine = of_sample.without_closing(place.sample + k, mine);
            }
        }
        for (int k = 0; k < 3; ++k) change[3 * row + std::size_t(k)] = mine[k];
    }
};

/// Shortens a row's change to what the segments allow that its slots reach. `holds`: a segment that allows less than `enough` does
/// not move at all; else one that allows nothing has had its closing left out, and moves with what remains.
template <class Real>
struct ShortenRow {
    ClothView<Real> cloth;
    View<const double> share;
    double enough;
    bool holds;
    View<Real> change;

    WEAVE_HD void operator()(std::size_t row) const {
        const YarnSpan& span = cloth.span[cloth.yarn_of_row[row]];
        double least = 1;
        for (std::uint32_t i = cloth.first_slot_of_row[row]; i < cloth.first_slot_of_row[row + 1]; ++i) {
            const std::uint32_t within = cloth.slots_of_row[i].slot - span.first_slot;
            for (std::uint32_t c = 0; c < 4 && c <= within; ++c) {
                if (within - c >= span.segments) continue;
                double of = share[span.first_segment + within - c];
                if (holds) of = of < enough ? 0 : 1;
                else if (!(of > 0)) of = 1;
                least = of < least ? of : least;
            }
        }
        for (std::size_t k = 0; k < 3; ++k) change[3 * row + k] *= static_cast<Real>(least);
    }
};

template <class Real>
struct Scale {
    Real by;
    View<Real> numbers;

    WEAVE_HD void operator()(std::size_t index) const { numbers[index] *= by; }
};

/// How far a change of the rows may be made: the rules of Energy::safe_share and Energy::shorten for any crew. The lists are
/// those of the state.
template <class Real>
struct SafeSteps {
    ClothView<Real> cloth;
    View<Moved<Real>> moved;  ///< per own sample
    View<double> share;       ///< per segment

    /// How much of a change, at most `most`, may be made at once so that no two yarns can pass through one another.
    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD double safe_share(Crew& crew, const ListsView<Real>& lists, const View<const double>& state, const View<const Real>& change,
                               double most) const {
        crew.each(cloth.samples, MoveSamples<Real>{cloth, change, moved});
        return crew.least(cloth.samples, SafeShare<Real>{cloth, lists, state, moved, most}, most);
    }

    /// Shortens a change where it is not safe: each row goes as far as the samples near it allow, and not at all where they do not
    /// come to agree. At least 0.9 of what is left is safe.
    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD void shorten(Crew& crew, const ListsView<Real>& lists, const View<const double>& state, const View<Real>& change) const {
        using Rounds = ShorteningRounds;
        const SafeShare<Real> of_sample{cloth, lists, state, moved, 1};
        for (int round = 0; round < Rounds::most; ++round) {
            crew.each(cloth.samples, MoveSamples<Real>{cloth, change, moved});
            crew.each(cloth.segments, SafeShareOfSegment<Real>{of_sample, share});
            const double least = crew.least(cloth.segments, Number<double>{share}, 1);
            if (least >= Rounds::enough) return;
            // What is still not safe does not move at all: else one place would hold up the whole cloth.
            const bool holds = round >= Rounds::gentle;
            if (!holds && !(least > 0)) crew.each(cloth.rows, LeaveOutClosing<Real>{of_sample, share, change});
            crew.each(cloth.rows, ShortenRow<Real>{cloth, share, Rounds::enough, holds, change});
        }
        // Rounds may run out before all places agree; then all of it is shortened alike.
        const double whole = safe_share(crew, lists, state, change, 1);
        if (whole < Rounds::enough) crew.each(3 * std::size_t(cloth.rows), Scale<Real>{static_cast<Real>(whole), change});
    }
};

}  // namespace weave::sim
