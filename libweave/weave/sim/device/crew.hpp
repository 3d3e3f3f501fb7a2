#pragma once

// Who works on bodies together. The device's solver is written once, for any crew: the threads of one kernel that stays on the
// device (Gang), kernels launched one after the other (launches.cuh), or the processor's cores (cores.hpp).
//
// In a gang every thread runs the same code and calls the same members in the same order with the same arguments; members return
// the same to all of them. A member returns when all have done their part and all that was written is seen by all. What decides
// the way on must therefore come from arguments or from what members returned. Bodies and terms are small named functors; a body
// runs once for every index below `count`, in any order, and no two indices write the same place.
//
//   each(count, body)              body(i)
//   sum(count, term)               Σ term(i), a double; in an order that depends on the crew alone
//   greatest(count, term)          greatest term(i), at least 0
//   least(count, term, start)      least term(i), at most `start`
//   sums(out, sums, count, term)   out[k] = Σ_i term(k, i) for each k below `sums`, at most most_sums
//   scan(counts, count)            counts[i] becomes the sum of those before it; returns the sum of all
//   read(view, index)              a number that a body has written
//   alone(body)                    body(), once
//   in_one_block(task)             task(crew), by as many as can wait for one another quickly, that is a block

#include <weave/sim/device/view.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

inline constexpr std::size_t most_sums = 64;

/// One thread that is a gang by itself.
struct OneThread {
    double* m_shared;  ///< one number

    WEAVE_HD std::size_t thread() const { return 0; }
    WEAVE_HD std::size_t threads() const { return 1; }
    WEAVE_HD std::size_t block() const { return 0; }
    WEAVE_HD std::size_t blocks() const { return 1; }
    WEAVE_HD void sync_block() const {}
    WEAVE_HD void sync_all() const {}
    WEAVE_HD double* shared() const { return m_shared; }
};

/// Of some threads those that share a block.
template <class Threads>
struct BlockOf {
    Threads all;

    WEAVE_HD std::size_t thread() const { return all.thread(); }
    WEAVE_HD std::size_t threads() const { return all.threads(); }
    WEAVE_HD std::size_t block() const { return 0; }
    WEAVE_HD std::size_t blocks() const { return 1; }
    WEAVE_HD void sync_block() const { all.sync_block(); }
    WEAVE_HD void sync_all() const { all.sync_block(); }
    WEAVE_HD double* shared() const { return all.shared(); }
};

/// Numbers that a gang of so many blocks needs for its sums, and for those of a block that works alone.
constexpr std::size_t parts_of_gang(std::size_t blocks) {
    return 2 * most_sums * (blocks + 1);
}

/// Threads in blocks, each with memory that its block shares (`shared()`: a number for each thread), which can wait for their
/// block (sync_block) or for all (sync_all). Of the threads an object each.
template <class Threads>
class Gang {
  public:
    /// `parts`: parts_of_gang() numbers that all blocks see.
    WEAVE_HD Gang(const Threads& threads, View<double> parts) : m_threads(threads), m_parts(parts) {}

    template <class Body>
    WEAVE_HD void each(std::size_t count, const Body& body) {
        for (std::size_t i = index(); i < count; i += size()) body(i);
        m_threads.sync_all();
    }

    template <class Term>
    WEAVE_HD double sum(std::size_t count, const Term& term) {
        return reduce(count, term, 0, Plus{});
    }
    template <class Term>
    WEAVE_HD double greatest(std::size_t count, const Term& term) {
        return reduce(count, term, 0, Greater{});
    }
    template <class Term>
    WEAVE_HD double least(std::size_t count, const Term& term, double start) {
        return reduce(count, term, start, Less{});
    }

    template <class Term>
    WEAVE_HD void sums(View<double> out, std::size_t sums, std::size_t count, const Term& term) {
        const std::size_t turn = next_turn();
        for (std::size_t k = 0; k < sums; ++k) {
            double mine = 0;
            for (std::size_t i = index(); i < count; i += size()) mine += term(k, i);
            const double part = reduce_block(mine, Plus{});
            if (m_threads.thread() == 0) m_parts[turn + k * m_threads.blocks() + m_threads.block()] = part;
        }
        m_threads.sync_all();
        for (std::size_t k = index(); k < sums; k += size()) {
            double sum = 0;
            for (std::size_t b = 0; b < m_threads.blocks(); ++b) sum += m_parts[turn + k * m_threads.blocks() + b];
            out[k] = sum;
        }
        m_threads.sync_all();
    }

    WEAVE_HD std::size_t scan(View<std::uint32_t> counts, std::size_t count) {
        const std::size_t turn = next_turn(), first = count * index() / size(), last = count * (index() + 1) / size();
        double mine = 0;
        for (std::size_t i = first; i < last; ++i) mine += counts[i];
        double before = scan_block(mine);
        if (m_threads.thread() + 1 == m_threads.threads()) m_parts[turn + m_threads.block()] = before + mine;
        m_threads.sync_all();
        double all = 0;
        for (std::size_t b = 0; b < m_threads.blocks(); ++b) {
            if (b < m_threads.block()) before += m_parts[turn + b];
            all += m_parts[turn + b];
        }
        for (std::size_t i = first; i < last; ++i) {
            const std::uint32_t own = counts[i];
            counts[i] = static_cast<std::uint32_t>(before);
            before += own;
        }
        m_threads.sync_all();
        return static_cast<std::size_t>(all);
    }

    template <class T>
    WEAVE_HD std::remove_const_t<T> read(const View<T>& view, std::size_t at) {
        const std::remove_const_t<T> value = view[at];
        m_threads.sync_all();  // before someone changes it
        return value;
    }

    template <class Body>
    WEAVE_HD void alone(const Body& body) {
        if (index() == 0) body();
        m_threads.sync_all();
    }

    template <class Task>
    WEAVE_HD void in_one_block(const Task& task) {
        if (m_threads.block() == 0) {
            Gang<BlockOf<Threads>> block({m_threads}, m_parts.slice(2 * most_sums * m_threads.blocks(), 2 * most_sums));
            task(block);
        }
        m_threads.sync_all();
    }

  private:
    struct Plus {
        WEAVE_HD double operator()(double a, double b) const { return a + b; }
    };
    struct Greater {
        WEAVE_HD double operator()(double a, double b) const { return a > b ? a : b; }
    };
    struct Less {
        WEAVE_HD double operator()(double a, double b) const { return a < b ? a : b; }
    };

    WEAVE_HD std::size_t index() const { return m_threads.block() * m_threads.threads() + m_threads.thread(); }
    WEAVE_HD std::size_t size() const { return m_threads.blocks() * m_threads.threads(); }

    /// Where the parts of the next sum lie: those of the one before may still be read.
    WEAVE_HD std::size_t next_turn() {
        m_turn = 1 - m_turn;
        return m_turn * most_sums * m_threads.blocks();
    }

    template <class Term, class Join>
    WEAVE_HD double reduce(std::size_t count, const Term& term, double start, const Join& join) {
        double mine = start;
        for (std::size_t i = index(); i < count; i += size()) mine = join(mine, static_cast<double>(term(i)));
        const double part = reduce_block(mine, join);
        if (m_threads.blocks() == 1) return part;
        const std::size_t turn = next_turn();
        if (m_threads.thread() == 0) m_parts[turn + m_threads.block()] = part;
        m_threads.sync_all();
        mine = start;
        for (std::size_t b = m_threads.thread(); b < m_threads.blocks(); b += m_threads.threads())
            mine = join(mine, m_parts[turn + b]);
        return reduce_block(mine, join);
    }

    /// Joins a number of each thread of the block, in the order of a tree.
    template <class Join>
    WEAVE_HD double reduce_block(double mine, const Join& join) {
        double* shared = m_threads.shared();
        const std::size_t thread = m_threads.thread(), threads = m_threads.threads();
        m_threads.sync_block();  // what was there has been read
        shared[thread] = mine;
        for (std::size_t width = 1; width < threads; width *= 2) {
            m_threads.sync_block();
            if (thread % (2 * width) == 0 && thread + width < threads)
                shared[thread] = join(shared[thread], shared[thread + width]);
        }
        m_threads.sync_block();
        return shared[0];
    }

    /// The sum of the numbers of the threads before this one in its block.
    WEAVE_HD double scan_block(double mine) {
        double* shared = m_threads.shared();
        const std::size_t thread = m_threads.thread(), threads = m_threads.threads();
        m_threads.sync_block();
        shared[thread] = mine;
        double sum = mine;
        for (std::size_t width = 1; width < threads; width *= 2) {
            m_threads.sync_block();
            const double other = thread >= width ? shared[thread - width] : 0;
            m_threads.sync_block();
            sum += other;
            shared[thread] = sum;
        }
        return sum - mine;
    }

    Threads m_threads;
    View<double> m_parts;
    std::size_t m_turn = 0;
};

}  // namespace weave::sim
