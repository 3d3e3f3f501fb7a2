#include "store_case.hpp"
#include "store_model.hpp"

#include <weave/sql/database.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <support/fault_vfs.hpp>
#include <sys/wait.h>
#include <thread>

using namespace weave;
using namespace weave::simd;
using namespace weave::simd::testing;
using weave::testing::DiskFault;
using weave::testing::FaultDisk;

namespace {

void tell_seed(const char* what, std::size_t rounds) {
    std::printf("seed %llu, %zu %s\n", static_cast<unsigned long long>(weave::testing::run_seed()), rounds,
                what);
}

/// Whether SQLite finds nothing wrong with the file.
bool is_sound(const std::filesystem::path& path) {
    const auto connection = sql::Connection::open(path.string(), sql::Access::write);
    if (!connection) return false;
    const auto word =
        (*connection)->one("PRAGMA integrity_check", [](const sql::Row& row) { return row.bytes(0); });
    const auto dangling = (*connection)->number("SELECT count(*) FROM pragma_foreign_key_check");
    return word && *word == "ok" && dangling && *dangling == 0;
}

/// The model as a new daemon finds it.
Model reopened(Model model) {
    model.reopen();
    return model;
}

/// Opens the store after a fault and holds it to the model without, or with, the operation that was under
/// way. The model goes on from what is there.
std::unique_ptr<Store> compare_after(const std::filesystem::path& path, Model& model, const Operation& last) {
    auto store = opened(path);
    const std::string found = told(*store);
    Model without = reopened(model);
    model.apply(last);
    model.reopen();
    if (found == model.told()) return store;
    REQUIRE(found == without.told());
    model = std::move(without);
    return store;
}

/// In a child: makes one operation after another, as the parent will, and tells how many are done.
[[noreturn]] void work_for_ever(const std::filesystem::path& path, int pipe, Model model,
                                std::uint64_t seed) {
    auto store = Store::open(path);
    if (!store) ::_exit(1);
    std::thread other([&] {
        for (int k = 0;; ++k)
            if (!(*store)->remember("somebody", "request-" + std::to_string(k), std::string(3000, 'a')))
                ::_exit(2);
    });
    Random random(seed);
    for (std::uint64_t done = 1;; ++done) {
        const Operation operation = model.random(random);
        if (apply(**store, operation) != model.apply(operation)) ::_exit(3);
        if (::write(pipe, &done, sizeof done) != sizeof done) ::_exit(4);
    }
}

/// Kills such a child some time after its first operation; how many it had told of.
std::uint64_t kill_a_worker(const std::filesystem::path& path, const Model& model, std::uint64_t seed,
                            useconds_t delay_us) {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    std::fflush(stdout);
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ends[0]);
        work_for_ever(path, ends[1], model, seed);
    }
    ::close(ends[1]);
    std::uint64_t done = 0, last = 0;
    while (::read(ends[0], &done, sizeof done) == sizeof done) {
        last = done;
        if (done != 1) continue;
        ::usleep(delay_us);
        ::kill(child, SIGKILL);
    }
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    INFO("the child ended with " << WEXITSTATUS(status));
    REQUIRE(WIFSIGNALED(status));
    return last;
}

void kill_often(std::size_t rounds) {
    tell_seed("kills", rounds);
    Random random(weave::testing::run_seed());
    std::unique_ptr<Folder> folder;
    Model model;
    std::uint64_t all = 0;
    for (std::size_t round = 0; round < rounds; ++round) {
        if (round % 10 == 0) {
            folder = std::make_unique<Folder>();
            model = {};
        }
        const std::uint64_t seed = random.between(0, SIZE_MAX);
        const auto path = *folder / "s.db";
        const auto done =
            kill_a_worker(path, model, seed, static_cast<useconds_t>(random.between(0, 60'000)));
        Random same(seed);
        for (std::uint64_t k = 0; k < done; ++k) model.apply(model.random(same));
        INFO("round " << round << ", " << done << " operations");
        compare_after(path, model, model.random(same));
        REQUIRE(is_sound(path));
        all += done;
    }
    std::printf("%llu acknowledged operations, none lost\n", static_cast<unsigned long long>(all));
}

void lose_power_often(std::size_t rounds) {
    tell_seed("power losses", rounds);
    Random random(weave::testing::run_seed());
    FaultDisk disk;
    std::unique_ptr<Folder> folder;
    Model model;
    std::size_t all = 0;
    for (std::size_t round = 0; round < rounds; ++round) {
        if (round % 10 == 0) {
            folder = std::make_unique<Folder>();
            model = {};
        }
        const auto path = *folder / "s.db";
        auto store = opened(path);
        model.reopen();
        disk.plan(DiskFault::power_loss, random.between(1, 200), random.between(0, SIZE_MAX));
        Operation last;
        for (bool lit = true; lit;) {
            last = model.random(random);
            const std::string said = apply(*store, last);
            lit = !disk.happened();
            if (!lit) break;
            REQUIRE(said == model.apply(last));
            ++all;
        }
        store.reset();
        disk.restore_power();
        INFO("round " << round);
        compare_after(path, model, last);
        REQUIRE(is_sound(path));
    }
    std::printf("%zu acknowledged operations, none lost\n", all);
}

/// One round of the story: the fault comes at call `at` of writing, truncating and flushing. Each operation
/// that it takes is a clean error and goes through when it is made again. Whether the fault came.
bool meet_fault(FaultDisk& disk, const std::filesystem::path& path, DiskFault fault, std::uint64_t at,
                std::uint64_t seed) {
    Model model;
    Random random(seed);
    disk.plan(fault, at);
    auto made = Store::open(path);
    if (!made) {
        REQUIRE(made.error().code == ErrorCode::system);
        made = Store::open(path);
    }
    REQUIRE(made);
    std::unique_ptr<Store> store = *std::move(made);
    for (int k = 0; k < 40; ++k) {
        const Operation operation = model.random(random);
        const std::string expected = model.apply(operation);
        std::string said = apply(*store, operation);
        if (said != expected) {
            INFO("operation " << k << " of kind " << static_cast<int>(operation.kind));
            REQUIRE(said == kind_of(ErrorCode::system));
            REQUIRE(disk.happened());
            apply(*store, operation);  // asked again, it says what it would have said, or that it was done
        }
        if (k % 10 == 9) REQUIRE(told(*store) == model.told());
    }
    store.reset();
    const bool happened = disk.happened();
    disk.plan(DiskFault::none, 0);
    REQUIRE(told(*opened(path)) == reopened(model).told());
    REQUIRE(is_sound(path));
    return happened;
}

}  // namespace

TEST_CASE("a store does what plain containers do, whatever is asked and whenever it is opened anew") {
    const std::size_t cases = std::max<std::size_t>(weave::testing::property_cases() / 5, 50);
    tell_seed("operations", cases);
    Random random(weave::testing::run_seed());
    const FaultDisk disk;  // flushes nothing, which is faster
    const Folder folder;
    Model model;
    auto store = opened(folder / "s.db");
    for (std::size_t k = 0; k < cases; ++k) {
        const Operation operation = model.random(random);
        INFO("operation " << k << " of kind " << static_cast<int>(operation.kind));
        REQUIRE(apply(*store, operation) == model.apply(operation));
        if (random.between(0, 9) == 0) {
            store.reset();
            store = opened(folder / "s.db");
            model.reopen();
        }
        if (random.between(0, 19) == 0) REQUIRE(told(*store) == model.told());
    }
    REQUIRE(told(*store) == model.told());
}

TEST_CASE("kill -9 takes back nothing that the store acknowledged") {
    kill_often(60);
}

TEST_CASE("500 kills take back nothing that the store acknowledged", "[.][long]") {
    kill_often(500);
}

TEST_CASE("a power loss takes back nothing that the store acknowledged") {
    lose_power_often(40);
}

TEST_CASE("1,000 power losses take back nothing that the store acknowledged", "[.][long]") {
    lose_power_often(1000);
}

TEST_CASE(
    "a full disk, an I/O error or a short write at any write is a clean error, and the same call goes "
    "through") {
    const std::uint64_t seed = weave::testing::run_seed();
    tell_seed("as seed", 1);
    for (const DiskFault fault : {DiskFault::full, DiskFault::io_error, DiskFault::short_write}) {
        FaultDisk disk;
        bool happened = true;
        for (std::uint64_t at = 1; happened; ++at) {
            const Folder folder;
            INFO("fault " << static_cast<int>(fault) << " at call " << at);
            happened = meet_fault(disk, folder / "s.db", fault, at, seed);
        }
    }
}
