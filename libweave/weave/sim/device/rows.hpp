#pragma once

// Bodies and terms over vectors of rows: what steps and conjugate gradients do with them.

#include <weave/sim/cloth.hpp>
#include <weave/sim/device/cloth_view.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// A number of an array as a term of a sum.
template <class T>
struct Number {
    View<const T> of;

    WEAVE_HD double operator()(std::size_t index) const { return static_cast<double>(of[index]); }
};

template <class Real>
struct Dot {
    View<const Real> a, b;

    WEAVE_HD double operator()(std::size_t index) const { return static_cast<double>(a[index]) * static_cast<double>(b[index]); }
};

/// |three numbers|² of a row.
template <class Real>
struct Length2 {
    View<const Real> of;

    WEAVE_HD double operator()(std::size_t row) const {
        return static_cast<double>(load(of.at(3 * row, 3)).squaredNorm());
    }
};

template <class T>
struct Copy {
    View<const T> from;
    View<T> to;

    WEAVE_HD void operator()(std::size_t index) const { to[index] = from[index]; }
};

/// sum := share·a + b
template <class Real>
struct AddScaled {
    Real share;
    View<const Real> a, b;
    View<Real> sum;

    WEAVE_HD void operator()(std::size_t index) const { sum[index] = share * a[index] + b[index]; }
};

/// to := share·from
template <class Real>
struct ScaledCopy {
    Real share;
    View<const Real> from;
    View<Real> to;

    WEAVE_HD void operator()(std::size_t index) const { to[index] = share * from[index]; }
};

/// One step of conjugate gradients.
template <class Real>
struct MoveAlong {
    Real share;
    View<const Real> direction, product;
    View<Real> step, residual;

    WEAVE_HD void operator()(std::size_t index) const {
        step[index] += share * direction[index];
        residual[index] -= share * product[index];
    }
};

/// Conjugate gradients from the gradient: step := 0, residual := −gradient.
template <class Real>
struct StartDownhill {
    View<const Real> gradient;
    View<Real> step, residual;

    WEAVE_HD void operator()(std::size_t index) const {
        step[index] = 0;
        residual[index] = -gradient[index];
    }
};

/// The same from numbers between −1 and 1.
template <class Real>
struct StartAnyhow {
    View<Real> step, residual;

    WEAVE_HD void operator()(std::size_t index) const {
        step[index] = 0;
        residual[index] = static_cast<Real>(some_number(index));
    }
};

/// A row's change is 0 where it leads up the gradient.
template <class Real>
struct StopUphill {
    View<const Real> gradient;
    View<Real> change;

    WEAVE_HD void operator()(std::size_t row) const {
        const std::size_t at = 3 * row;
        if (!(gradient[at] * change[at] + gradient[at + 1] * change[at + 1] + gradient[at + 2] * change[at + 2] > 0)) return;
        for (std::size_t k = 0; k < 3; ++k) change[at + k] = 0;
    }
};

/// A slot of a state goes a share of the change of its rows.
template <class Real>
struct GoAlong {
    ClothView<Real> cloth;
    View<const double> before;
    View<const Real> change;
    double share;
    View<double> state;

    WEAVE_HD void operator()(std::size_t slot) const {
        const Vec<Real> by = movement_of(cloth, change, slot);
        for (std::size_t k = 0; k < 3; ++k) state[3 * slot + k] = before[3 * slot + k] + share * static_cast<double>(by[int(k)]);
    }
};

/// The length of a row's force as a whole number that rises with it: 0 only where there is none.
template <class Real>
struct ForceKey {
    View<const Real> force;
    View<std::uint32_t> key;

    WEAVE_HD void operator()(std::size_t row) const {
        key[row] = std::bit_cast<std::uint32_t>(static_cast<float>(load(force.at(3 * row, 3)).norm()));
    }
};

/// Whether a key is above 0 and at most `most`.
struct KeyUpTo {
    View<const std::uint32_t> key;
    std::uint32_t most;

    WEAVE_HD double operator()(std::size_t row) const { return key[row] > 0 && key[row] <= most ? 1 : 0; }
};

/// The length that such a key stands for.
WEAVE_HD inline double length_of(std::uint32_t key) {
    return static_cast<double>(std::bit_cast<float>(key));
}

}  // namespace weave::sim
