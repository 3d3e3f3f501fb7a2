#pragma once

// How a machine (relax_on.hpp) gives numbers to the threads of a kernel and has them back.

#include <weave/sim/device/view.hpp>

#include <cstddef>

namespace weave::sim {

/// A kernel with numbers for its threads: each has its own, which begin alike; one of them writes its back. The kernel lets its threads
/// wait for one another at least once.
template <class Kernel, class Numbers>
struct WithNumbers {
    Kernel kernel;
    View<Numbers> kept;  ///< one

    struct Keep {
        View<Numbers> kept;
        Numbers own;
        WEAVE_HD void operator()() const { kept[0] = own; }
    };

    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        Numbers own = kept[0];
        kernel(crew, own);
        crew.alone(Keep{kept, own});
    }
};

/// Many such, each with numbers of its own.
template <class Kernel, class Numbers>
struct EachWithNumbers {
    View<const Kernel> kernels;
    View<Numbers> kept;

    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD void operator()(Crew& crew, std::size_t k) const {
        WithNumbers<Kernel, Numbers>{kernels[k], kept.slice(k, 1)}(crew);
    }
};

}  // namespace weave::sim
