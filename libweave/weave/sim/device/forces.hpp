#pragma once

#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/lists.hpp>
#include <weave/sim/device/rows.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// What the neighbours of one own sample do to it.
template <class Real>
struct SampleContact {
    ListsView<Real> lists;
    Real floor, step_mm;
    View<ContactSum<Real>> contact;  ///< per own sample

    WEAVE_HD void operator()(std::size_t index) const {
        const Sample<Real> mine = lists.sample[index];
        const Real radius = lists.radius[index];
        ContactSum<Real> sum;
        const std::uint32_t end = lists.first[index + 1];
        for (std::uint32_t e = lists.first[index]; e < end; ++e) {
            const std::uint32_t b = lists.neighbour[e];
            const Sample<Real> other = lists.sample[b];
            add_neighbour(apart(mine, other, step_mm), radius + lists.radius[b], other.weight, floor, sum);
        }
        contact[index] = sum;
    }
};

/// Energy of one segment and its gradient by its four slots, from its samples' contacts.
template <class Real>
struct SegmentPull {
    ClothView<Real> cloth;
    ListsView<Real> lists;
    View<const double> state;
    View<const ContactSum<Real>> contact;
    Real give;
    Terms terms;
    View<double> energy;   ///< per segment
    View<Real> gradient;   ///< number k of segment s at k·segments + s

    WEAVE_HD void operator()(std::size_t index) const {
        const SegmentPlace segment = cloth.segment[index];
        const YarnConstants<Real>& yarn = cloth.yarn[segment.yarn];
        const Gauss<Real>& gauss = cloth.gauss[0];
        Real slots[12];
        load_around_first(state, segment.slot, slots);
        SegmentSum<Real> sum;
        double heavy = 0;
        if (terms.elastic) {
            const Speeds<Real> speeds(gauss, slots);
            add_stretch(yarn, gauss, speeds, give, sum);
            add_bending(yarn, gauss, slots, speeds, sum);
            if (cloth.fields > 0) push_out(segment, yarn, slots, sum);
            if (cloth.weight_N) heavy = weigh(segment, slots, sum);
        }
        if (terms.contact) {
            add_contact(
                yarn, cloth.basis.at(yarn.basis, yarn.samples), slots, [&](std::uint32_t k) { return contact[segment.sample + k]; },
                [&](std::uint32_t k) { return lists.sample[segment.sample + k].weight; }, sum);
        }
        energy[index] = static_cast<double>(sum.energy) + heavy;
        for (std::size_t k = 0; k < 12; ++k) gradient[k * cloth.segments + index] = sum.gradient[k];
    }

  private:
    /// The spheres as seen from the segment's first slot.
    WEAVE_HD void push_out(const SegmentPlace& segment, const YarnConstants<Real>& yarn, const Real* slots, SegmentSum<Real>& sum) const {
        const double* first = state.at(3 * std::size_t(segment.slot), 3);
        const Vec<Real> from(static_cast<Real>(first[0]), static_cast<Real>(first[1]), static_cast<Real>(first[2]));
        add_fields(
            yarn, cloth.gauss[0], slots, cloth.fields,
            [&](std::size_t s) {
                Sphere<Real> sphere = cloth.spheres[s];
                sphere.centre -= from;
                return sphere;
            },
            sum);
    }

    /// Weight times mean height, which is ∫ of the four splines.
    WEAVE_HD double weigh(const SegmentPlace& segment, const Real* slots, SegmentSum<Real>& sum) const {
        constexpr double shares[]{1.0 / 24, 11.0 / 24, 11.0 / 24, 1.0 / 24};
        const double weight = cloth.weight_N[segment.yarn];
        double height = state[3 * std::size_t(segment.slot) + 2];
        for (int c = 0; c < 4; ++c) {
            height += shares[c] * static_cast<double>(slots[3 * c + 2]);
            sum.gradient[3 * c + 2] += static_cast<Real>(weight * shares[c]);
        }
        return weight * height;
    }
};

/// Each row adds up what the segments that reach its slots have found: segment s - c of its yarn at its place c.
template <class Real>
struct GatherPull {
    ClothView<Real> cloth;
    View<const Real> by_segment;
    View<Real> gradient;

    WEAVE_HD void operator()(std::size_t row) const {
        const YarnSpan& span = cloth.span[cloth.yarn_of_row[row]];
        Vec<Real> sum = Vec<Real>::Zero();
        for (std::uint32_t i = cloth.first_slot_of_row[row]; i < cloth.first_slot_of_row[row + 1]; ++i) {
            const RowSlot slot = cloth.slots_of_row[i];
            const std::uint32_t within = slot.slot - span.first_slot;
            for (std::uint32_t c = 0; c < 4 && c <= within; ++c) {
                if (within - c >= span.segments) continue;
                const std::size_t segment = span.first_segment + within - c;
                for (std::size_t k = 0; k < 3; ++k)
                    sum[int(k)] += Real(slot.weight) * by_segment[(3 * c + k) * cloth.segments + segment];
            }
        }
        for (std::size_t k = 0; k < 3; ++k) gradient[3 * row + k] = sum[int(k)];
    }
};

template <class Real>
struct ForcesRoom {
    View<ContactSum<Real>> contact;  ///< per own sample
    View<double> energy;             ///< per segment
    View<Real> by_segment;           ///< 12 a segment
};

/// Energy, N·mm, and ∂E/∂q of a state whose lists are made, 3 numbers a row.
WEAVE_ANYWHERE template <class Real, class Crew>
WEAVE_HD double pull(Crew& crew, const ClothView<Real>& cloth, const ListsView<Real>& lists, const ForcesRoom<Real>& room,
                     const View<const double>& state, Real give, Terms terms, const View<Real>& gradient) {
    if (terms.contact)
        crew.each(cloth.samples, SampleContact<Real>{lists, cloth.floor, static_cast<Real>(cloth.scale.step_mm), room.contact});
    crew.each(cloth.segments, SegmentPull<Real>{cloth, lists, state, room.contact, give, terms, room.energy, room.by_segment});
    crew.each(cloth.rows, GatherPull<Real>{cloth, room.by_segment, gradient});
    return crew.sum(cloth.segments, Number<double>{room.energy});
}

}  // namespace weave::sim
