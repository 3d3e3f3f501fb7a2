#pragma once

#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/rows.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// So many pairs are remembered, in a ring that has a place more for the next.
inline constexpr std::uint32_t most_pairs = 16, places_for_pairs = most_pairs + 1;

template <class Real>
struct PairsRoom {
    std::size_t numbers = 0;   ///< of a vector of rows
    View<Real> change, bend;   ///< of places and of the gradient: places_for_pairs vectors
    View<double> products;     ///< change p · bend q at places_for_pairs·p + q
    View<double> sums;         ///< most_sums, as they were added up last
    View<double> share;        ///< of each pair in the direction, from the oldest on
};

/// What the last steps told of the energy (limited-memory BFGS; Nocedal 1980), in a form that asks for few sums: the two loops over
/// pairs need of vectors only their products with the gradient and with what the preconditioner made of it. Those among the pairs
/// are kept.
template <class Real>
class Pairs {
  public:
    WEAVE_HD explicit Pairs(const PairsRoom<Real>& room, std::uint32_t count = 0, std::uint32_t newest = 0)
        : m_room(room), m_count(count), m_newest(newest) {}

    WEAVE_HD void forget() { m_count = 0; }
    [[nodiscard]] WEAVE_HD std::uint32_t count() const { return m_count; }
    [[nodiscard]] WEAVE_HD std::uint32_t newest() const { return m_newest; }

    /// Keeps a share of the change and how it changed the gradient, unless the energy hardly curves upwards along it.
    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD void remember(Crew& crew, Real share, const View<const Real>& change, const View<const Real>& gradient, const View<const Real>& trial) {
        constexpr double least_bend = 1e-3;
        const std::uint32_t next = (m_newest + 1) % places_for_pairs;
        crew.each(m_room.numbers, ScaledCopy<Real>{share, change, vector(m_room.change, next)});
        crew.each(m_room.numbers, AddScaled<Real>{-1, gradient, trial, vector(m_room.bend, next)});
        const Products products{m_room, next, oldest(), m_count, gradient};
        crew.sums(m_room.sums, 2 + 2 * std::size_t(m_count), m_room.numbers, products);
        const double product = crew.read(m_room.sums, 0), slope = crew.read(m_room.sums, 1);
        if (!(product > least_bend * (slope < 0 ? -slope : slope))) return;
        crew.each(m_count + std::size_t{1}, KeepProducts{products});
        m_newest = next;
        if (m_count < most_pairs) ++m_count;
    }

    /// direction := −H·gradient, H being what the pairs make of the preconditioner `apply(residual, step)`. `work` and `solved` are
    /// scratch.
    WEAVE_ANYWHERE template <class Crew, class Apply>
    WEAVE_HD void find_direction(Crew& crew, const View<const Real>& gradient, Apply& apply, const View<Real>& work, const View<Real>& solved,
                                 const View<Real>& direction) {
        if (m_count == 0) {
            apply(gradient, solved);
            crew.each(m_room.numbers, ScaledCopy<Real>{-1, solved, direction});
            return;
        }
        crew.sums(m_room.sums, m_count, m_room.numbers, WithEach{m_room, m_room.change, oldest(), gradient});
        crew.alone(SolveBack{m_room, oldest(), m_count});
        crew.each(m_room.numbers, TakeBends{m_room, oldest(), m_count, gradient, work});
        apply(work, solved);
        const View<const Real> latest = vector(m_room.bend, m_newest);
        apply(latest, work);
        const double bent = crew.sum(m_room.numbers, Dot<Real>{latest, work});
        const double scale = crew.read(m_room.products, places_for_pairs * m_newest + m_newest) / bent;
        crew.sums(m_room.sums, m_count, m_room.numbers, WithEach{m_room, m_room.bend, oldest(), solved});
        crew.alone(SolveForth{m_room, oldest(), m_count, scale});
        crew.each(m_room.numbers, AddChanges{m_room, oldest(), m_count, static_cast<Real>(scale), solved, direction});
    }

  private:
    [[nodiscard]] WEAVE_HD View<Real> vector(const View<Real>& of, std::uint32_t place) const {
        return of.slice(place * m_room.numbers, m_room.numbers);
    }
    [[nodiscard]] WEAVE_HD std::uint32_t oldest() const { return (m_newest + places_for_pairs + 1 - m_count) % places_for_pairs; }

    /// The k-th pair from the oldest on.
    WEAVE_HD static std::uint32_t place(std::uint32_t oldest, std::size_t k) { return (oldest + std::uint32_t(k)) % places_for_pairs; }

  public: // nvcc launches no private type

    /// Of a new pair: change·bend, change·gradient, each older change · its bend, and its change · each older bend.
    struct Products {
        PairsRoom<Real> room;
        std::uint32_t next, oldest, count;
        View<const Real> gradient;

        WEAVE_HD double operator()(std::size_t k, std::size_t i) const {
            const double change = room.change[next * room.numbers + i], bend = room.bend[next * room.numbers + i];
            if (k == 0) return change * bend;
            if (k == 1) return change * static_cast<double>(gradient[i]);
            if (k < 2 + count) return static_cast<double>(room.change[place(oldest, k - 2) * room.numbers + i]) * bend;
            return change * static_cast<double>(room.bend[place(oldest, k - 2 - count) * room.numbers + i]);
        }
    };

    struct KeepProducts {
        Products of;

        WEAVE_HD void operator()(std::size_t k) const {
            const PairsRoom<Real>& room = of.room;
            const std::size_t p = k < of.count ? place(of.oldest, k) : of.next;
            if (p == of.next) {
                room.products[places_for_pairs * p + p] = room.sums[0];
                return;
            }
            room.products[places_for_pairs * p + of.next] = room.sums[2 + k];
            room.products[places_for_pairs * of.next + p] = room.sums[2 + of.count + k];
        }
    };

    /// The k-th pair's vector · another.
    struct WithEach {
        PairsRoom<Real> room;
        View<const Real> vectors;
        std::uint32_t oldest;
        View<const Real> other;

        WEAVE_HD double operator()(std::size_t k, std::size_t i) const {
            return static_cast<double>(vectors[place(oldest, k) * room.numbers + i]) * static_cast<double>(other[i]);
        }
    };

    /// The loop from the newest pair to the oldest: the share of each bend that is taken from the gradient.
    struct SolveBack {
        PairsRoom<Real> room;
        std::uint32_t oldest, count;

        WEAVE_HD void operator()() const {
            for (std::size_t k = count; k-- > 0;) {
                const std::size_t row = places_for_pairs * place(oldest, k);
                double sum = room.sums[k];
                for (std::size_t j = k + 1; j < count; ++j) sum -= room.share[j] * room.products[row + place(oldest, j)];
                room.share[k] = sum / room.products[row + place(oldest, k)];
            }
        }
    };

    struct TakeBends {
        PairsRoom<Real> room;
        std::uint32_t oldest, count;
        View<const Real> gradient;
        View<Real> left;

        WEAVE_HD void operator()(std::size_t i) const {
            Real sum = gradient[i];
            for (std::uint32_t k = count; k-- > 0;) sum -= static_cast<Real>(room.share[k]) * room.bend[place(oldest, k) * room.numbers + i];
            left[i] = sum;
        }
    };

    /// The loop from the oldest pair to the newest: the share of each change that is added.
    struct SolveForth {
        PairsRoom<Real> room;
        std::uint32_t oldest, count;
        double scale;

        WEAVE_HD void operator()() const {
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t own = place(oldest, k);
                double sum = scale * room.sums[k];
                for (std::size_t j = 0; j < k; ++j) sum += room.share[j] * room.products[places_for_pairs * place(oldest, j) + own];
                room.share[k] -= sum / room.products[places_for_pairs * own + own];
            }
        }
    };

    struct AddChanges {
        PairsRoom<Real> room;
        std::uint32_t oldest, count;
        Real scale;
        View<const Real> solved;
        View<Real> direction;

        WEAVE_HD void operator()(std::size_t i) const {
            Real sum = scale * solved[i];
            for (std::uint32_t k = 0; k < count; ++k) sum += static_cast<Real>(room.share[k]) * room.change[place(oldest, k) * room.numbers + i];
            direction[i] = -sum;
        }
    };

  private:
    PairsRoom<Real> m_room;
    std::uint32_t m_count, m_newest;
};

}  // namespace weave::sim
