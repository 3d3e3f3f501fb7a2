#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <weave/block/block.hpp>

namespace weave::testing {

/// The number that an environment variable gives; an exception where it is anything but a number from `low` on, so
/// that a slip of the pen is no empty test that passes.
inline std::optional<std::size_t> number_from(const char* variable, std::size_t low) {
    const char* wish = std::getenv(variable);
    if (wish == nullptr) return {};
    std::size_t number = 0;
    const char* const end = wish + std::strlen(wish);
    const auto [stop, code] = std::from_chars(wish, end, number);
    if (code != std::errc{} || stop != end || number < low)
        throw std::runtime_error(std::string(variable) + "='" + wish + "' is not a number from " +
                                 std::to_string(low) + " on");
    return number;
}

/// Cases of a property test: 10,000, or what WEAVE_PROPERTY_CASES says (coverage and sanitizer builds lower it).
/// What is no number of cases fails the test, or it would pass untried.
inline std::size_t property_cases() {
    return number_from("WEAVE_PROPERTY_CASES", 1).value_or(10000);
}

/// The seed of this run: WEAVE_SEED, or a fresh one. Every property test prints it.
inline std::uint64_t run_seed() {
    static const std::uint64_t seed = number_from("WEAVE_SEED", 0).value_or(std::random_device{}());
    return seed;
}

/// Random numbers of one case.
class Random {
  public:
    explicit Random(std::uint64_t seed) : m_engine(seed) {}
    /// A whole number from `low` to `high`, both included.
    std::size_t between(std::size_t low, std::size_t high) {
        return std::uniform_int_distribution<std::size_t>(low, high)(m_engine);
    }
    bool coin() { return between(0, 1) == 1; }
    template <class T>
    void shuffle(std::vector<T>& items) {
        std::shuffle(items.begin(), items.end(), m_engine);
    }

  private:
    std::mt19937_64 m_engine;
};

/// Runs `property(random)` for property_cases() cases; a failure names the seed and case that repeat it.
template <class Property>
void for_all(Property property, std::size_t cases = property_cases(), std::uint64_t seed = run_seed()) {
    cases = std::max<std::size_t>(cases, 1);  // of a share of few, at least one
    std::printf("seed %llu, %zu cases\n", static_cast<unsigned long long>(seed), cases);
    for (std::size_t k = 0; k < cases; ++k) {
        INFO("WEAVE_SEED=" << seed << ", case " << k);
        Random random(seed + k * 0x9e3779b97f4a7c15);
        property(random);
    }
}

/// A stack of these yarns in random order with up to `most_empty` empty slots.
inline Stack random_stack(Random& random, std::size_t wefts, std::size_t warps, std::size_t most_empty = 2) {
    std::vector<Slot> slots;
    for (std::size_t k = 0; k < wefts; ++k) slots.push_back(Slot::weft(k, random.between(0, 9) == 0));
    for (std::size_t k = 0; k < warps; ++k) slots.push_back(Slot::warp(k, random.between(0, 9) == 0));
    slots.resize(slots.size() + random.between(0, most_empty));
    random.shuffle(slots);
    return Stack(std::move(slots));
}

/// A random block with up to `most` rows and columns, each with given or random (1 to 3) picks and ends.
inline Block random_block(Random& random, std::vector<std::uint32_t> t = {}, std::vector<std::uint32_t> p = {},
                          std::size_t most = 4) {
    const auto counts = [&](std::vector<std::uint32_t>& given) {
        if (!given.empty()) return;
        given.resize(random.between(1, most));
        for (auto& count : given) count = static_cast<std::uint32_t>(random.between(1, 3));
    };
    counts(t);
    counts(p);
    return make_block(
               t, p, [&](std::size_t i, std::size_t j) { return random_stack(random, t[i], p[j]); })
        .value();
}

}  // namespace weave::testing
