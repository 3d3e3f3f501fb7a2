// Threads: as many as there can be, and the work is done with however few.

#include <weave/sim/execute.hpp>

#include <catch2/catch.hpp>

#include <pthread.h>

using namespace weave::sim;

namespace {

double sum_to(const Executor& executor, std::size_t count) {
    return executor.sum(count, [](std::size_t i) { return static_cast<double>(i); });
}

}  // namespace

TEST_CASE("an executor has no more threads than help anybody") {
    const Executor executor(99'999);
    CHECK(executor.threads() <= most_threads);
    CHECK(sum_to(executor, 100'000) == 99'999.0 * 50'000);
}

TEST_CASE("where the machine gives no threads the work is done by one") {
    pthread_attr_t before, greedy;
    REQUIRE(pthread_getattr_default_np(&before) == 0);
    REQUIRE(pthread_attr_init(&greedy) == 0);
    REQUIRE(pthread_attr_setstacksize(&greedy, std::size_t{1} << 46) == 0);  // 64 TiB: more than a processor can address
    REQUIRE(pthread_setattr_default_np(&greedy) == 0);
    {
        const Executor executor(8);
        CHECK(executor.threads() == 1);
        CHECK(sum_to(executor, 100'000) == 99'999.0 * 50'000);
    }
    CHECK(pthread_setattr_default_np(&before) == 0);
    pthread_attr_destroy(&greedy);
    pthread_attr_destroy(&before);
    CHECK(Executor(3).threads() == 3);
}
