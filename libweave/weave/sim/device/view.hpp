#pragma once

#include <weave/sim/bodies.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#if defined(WEAVE_BOUNDS)
#include <cstdio>
#include <cstdlib>
#endif

namespace weave::sim {

/// Numbers that lie one after the other in the memory of some machine, which the view does not own. Built with WEAVE_BOUNDS
/// every access is checked and the program ends at one beyond the end; else a view is a pointer.
template <class T>
class View {
  public:
    View() = default;
    WEAVE_HD View(T* at, std::size_t size) : m_at(at) {
#if defined(WEAVE_BOUNDS)
        m_size = size;
#else
        static_cast<void>(size);
#endif
    }
    /// Of numbers that may be written, for who only reads them.
    template <class Other>
        requires std::is_same_v<T, const Other>
    WEAVE_HD View(const View<Other>& other) : View(other.m_at, other.checked_size()) {}

    WEAVE_HD T& operator[](std::size_t index) const {
        check(index, 1);
        return m_at[index];
    }
    /// Where numbers from `first` on lie, `count` of which are going to be used.
    WEAVE_HD T* at(std::size_t first, std::size_t count) const {
        check(first, count);
        return m_at + first;
    }
    WEAVE_HD View slice(std::size_t first, std::size_t count) const { return {at(first, count), count}; }
    WEAVE_HD explicit operator bool() const { return m_at != nullptr; }

    /// How many there are where accesses are checked; else 0.
    [[nodiscard]] WEAVE_HD std::size_t checked_size() const {
#if defined(WEAVE_BOUNDS)
        return m_size;
#else
        return 0;
#endif
    }

  private:
    template <class Other>
    friend class View;

    WEAVE_HD void check([[maybe_unused]] std::size_t first, [[maybe_unused]] std::size_t count) const {
#if defined(WEAVE_BOUNDS)
        if (first <= m_size && count <= m_size - first) return;
        printf("View: %llu numbers from %llu on, of %llu\n", static_cast<unsigned long long>(count),
               static_cast<unsigned long long>(first), static_cast<unsigned long long>(m_size));
#if defined(__CUDA_ARCH__)
        __trap();
#else
        std::abort();
#endif
#endif
    }

    T* m_at = nullptr;
#if defined(WEAVE_BOUNDS)
    std::size_t m_size = 0;
#endif
};

}  // namespace weave::sim
