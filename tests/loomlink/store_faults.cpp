#include "store_case.hpp"

#include <csignal>
#include <cstdio>
#include <mutex>
#include <support/fault_vfs.hpp>
#include <support/random.hpp>
#include <sys/wait.h>
#include <thread>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::DiskFault;
using weave::testing::FaultDisk;
using weave::testing::Random;

namespace {

/// What the store acknowledged: a record, and an object written with it.
struct Promise {
    Seq seq = 0;
    Hash leaf{};
    Hash object{};
};

/// One write: an event and an object of its own, of some thousand bytes that do not compress.
Result<Promise> write_one(Store& store, std::uint64_t number) {
    std::string bytes(2000 + number % 5 * 1500, '\0');
    std::uint64_t state = number * 2 + 1;
    for (char& c : bytes)
        c = static_cast<char>((state = state * 6364136223846793005U + 1442695040888963407U) >> 56);
    return store.write([&](Writer& writer) -> Result<Promise> {
        WEAVE_TRY(const Hash object, writer.put_object(bytes));
        WEAVE_TRY(const Seq seq, writer.append(statement_of(number)));
        WEAVE_TRY(const auto record, writer.events({seq, 1, {}, {}}));
        return Promise{seq, leaf_hash(record.front().second), object};
    });
}

/// Promises that the store does not hold any more.
std::size_t broken(const Store& store, const std::vector<Promise>& promises) {
    std::size_t count = 0;
    for (const Promise& promise : promises) {
        const Status kept = store.view([&](const Reader& reader) -> Status {
            WEAVE_TRY(const auto record, reader.events({promise.seq, 1, {}, {}}));
            WEAVE_TRY(const auto object, reader.object(promise.object));
            const bool whole = record.size() == 1 && record[0].first == promise.seq &&
                               leaf_hash(record[0].second) == promise.leaf && object;
            if (!whole) return bad_input("lost");
            return {};
        });
        count += kept ? 0 : 1;
    }
    return count;
}

/// Writes from three threads until the disk fails or each has written `most`.
std::vector<Promise> write_until_dark(Store& store, std::uint64_t first, std::uint64_t most) {
    std::vector<Promise> promises;
    std::mutex mutex;
    std::vector<std::thread> writers;
    for (std::uint64_t k = 0; k < 3; ++k) {
        writers.emplace_back([&, k] {
            for (std::uint64_t n = 0; n < most; ++n) {
                const auto promise = write_one(store, first + n * 3 + k);
                if (!promise) return;
                const std::lock_guard lock(mutex);
                promises.push_back(*promise);
            }
        });
    }
    for (std::thread& writer : writers) writer.join();
    return promises;
}

struct Losses {
    std::size_t acknowledged = 0;
    std::size_t lost = 0;
    std::size_t damaged = 0;  ///< rounds after which the store was not clean
};

/// Loses power in each of `rounds` rounds of writing. Every tenth round begins a new store, so that none
/// grows long.
Losses lose_power(std::size_t rounds, bool forget_full, std::uint64_t seed) {
    Losses losses;
    FaultDisk disk(forget_full);
    std::unique_ptr<Folder> folder;
    std::vector<Promise> promises;
    Random random(seed);
    std::printf("seed %llu, %zu power losses\n", static_cast<unsigned long long>(seed), rounds);
    for (std::size_t round = 0; round < rounds; ++round) {
        if (round % 10 == 0) {
            folder = std::make_unique<Folder>();
            promises.clear();
            static_cast<void>(Store::create(*folder / "s.db", "mill").value());
        }
        {
            Store store = Store::open(*folder / "s.db").value();
            disk.plan(DiskFault::power_loss, random.between(1, 400), random.between(0, SIZE_MAX));
            const auto more = write_until_dark(store, round * 1000, 40);
            promises.insert(promises.end(), more.begin(), more.end());
            losses.acknowledged += more.size();
            disk.cut_power();
        }
        disk.restore_power();
        const auto store = Store::open(*folder / "s.db");
        const std::size_t lost = store ? broken(*store, promises) : promises.size();
        losses.lost += lost;
        const auto findings = verify_store(*folder / "s.db");
        if (!store || !findings || !findings->empty()) ++losses.damaged;
        if (lost > 0) promises.clear();  // told once
        if (!store) round += 9 - round % 10;
    }
    return losses;
}

void expect_no_losses(std::size_t rounds) {
    const Losses losses = lose_power(rounds, false, weave::testing::run_seed());
    std::printf("%zu acknowledged writes, %zu lost, %zu stores damaged\n", losses.acknowledged, losses.lost,
                losses.damaged);
    REQUIRE(losses.acknowledged > rounds);
    REQUIRE(losses.lost == 0);
    REQUIRE(losses.damaged == 0);
}

void expect_losses(std::size_t rounds) {
    const Losses losses = lose_power(rounds, true, weave::testing::run_seed());
    std::printf("control: %zu acknowledged writes, %zu lost\n", losses.acknowledged, losses.lost);
    REQUIRE(losses.lost > 0);
}

/// In a child: writes for ever, and tells each promise through the pipe once it has it.
[[noreturn]] void write_for_ever(const std::filesystem::path& path, int pipe, std::uint64_t first) {
    auto store = Store::open(path);
    if (!store) ::_exit(1);
    std::vector<std::thread> writers;
    for (std::uint64_t k = 0; k < 3; ++k) {
        writers.emplace_back([&, k] {
            for (std::uint64_t n = 0;; ++n) {
                const auto promise = write_one(*store, first + n * 3 + k);
                if (!promise) ::_exit(2);
                if (::write(pipe, &*promise, sizeof *promise) != sizeof *promise)
                    ::_exit(3);  // below PIPE_BUF: whole or not
            }
        });
    }
    for (std::thread& writer : writers) writer.join();
    ::_exit(0);
}

/// Kills a child that writes, some time after its first promise, and gives back what it promised.
std::vector<Promise> kill_a_writer(const std::filesystem::path& path, std::uint64_t first, int delay_us) {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ends[0]);
        write_for_ever(path, ends[1], first);
    }
    ::close(ends[1]);
    std::vector<Promise> promises;
    Promise promise;
    while (::read(ends[0], &promise, sizeof promise) == sizeof promise) {
        promises.push_back(promise);
        if (promises.size() != 1) continue;
        ::usleep(static_cast<useconds_t>(delay_us));
        ::kill(child, SIGKILL);
    }
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    return promises;
}

void kill_often(std::size_t rounds) {
    Random random(weave::testing::run_seed());
    std::printf("seed %llu, %zu kills\n", static_cast<unsigned long long>(weave::testing::run_seed()),
                rounds);
    std::size_t acknowledged = 0;
    std::unique_ptr<Folder> folder;
    std::vector<Promise> promises;
    for (std::size_t round = 0; round < rounds; ++round) {
        if (round % 10 == 0) {
            folder = std::make_unique<Folder>();
            promises.clear();
            static_cast<void>(Store::create(*folder / "s.db", "mill").value());
        }
        const auto more =
            kill_a_writer(*folder / "s.db", round * 100000, static_cast<int>(random.between(0, 60000)));
        promises.insert(promises.end(), more.begin(), more.end());
        acknowledged += more.size();
        const Store store = Store::open(*folder / "s.db").value();
        REQUIRE(broken(store, promises) == 0);
        REQUIRE(all_text(verify_store(*folder / "s.db").value()).empty());
    }
    std::printf("%zu acknowledged writes, none lost\n", acknowledged);
}

}  // namespace

TEST_CASE("no power loss takes back what was acknowledged", "[file]") {
    expect_no_losses(60);
}

TEST_CASE("1,000 power losses take back nothing that was acknowledged", "[.][long][file]") {
    expect_no_losses(1000);
}

TEST_CASE("the power-loss disk bites: without full flushes it takes acknowledged writes back", "[file]") {
    expect_losses(20);
}

TEST_CASE("kill -9 takes back nothing that was acknowledged", "[file]") {
    kill_often(30);
}

TEST_CASE("1,000 kills take back nothing that was acknowledged", "[.][long][file]") {
    kill_often(1000);
}

TEST_CASE("a full disk, an I/O error or a short write at any write is a clean error, and the store goes on", "[file]") {
    for (const DiskFault fault : {DiskFault::full, DiskFault::io_error, DiskFault::short_write}) {
        const Folder folder;
        FaultDisk disk;
        static_cast<void>(Store::create(folder / "empty.db", "mill").value());
        for (std::uint64_t n = 1;; ++n) {
            std::filesystem::copy_file(folder / "empty.db", folder / "s.db",
                                       std::filesystem::copy_options::overwrite_existing);
            std::vector<Promise> promises;
            Store store = Store::open(folder / "s.db").value();
            disk.plan(fault, n);
            std::size_t failed = 0;
            for (std::uint64_t k = 0; k < 2; ++k) {
                const auto promise = write_one(store, n * 10 + k);
                if (promise) {
                    promises.push_back(*promise);
                    continue;
                }
                REQUIRE(promise.error().code == ErrorCode::system);
                ++failed;
            }
            const bool happened = disk.happened();
            disk.plan(DiskFault::none, 0);
            INFO("fault " << static_cast<int>(fault) << " at call " << n);
            REQUIRE(failed <= 1);
            const auto after = write_one(store, n * 10 + 5);  // the same store, without help
            REQUIRE(after);
            promises.push_back(*after);
            REQUIRE(broken(store, promises) == 0);
            REQUIRE(all_text(verify_store(folder / "s.db").value()).empty());
            if (!happened) break;
        }
    }
}
