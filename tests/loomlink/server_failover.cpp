// The primary is killed at work, again and again, and the standby takes its place as loomlink/RUNBOOK.md says.

#include "server_case.hpp"

#include <algorithm>
#include <fstream>
#include <mutex>
#include <support/random.hpp>
#include <thread>

namespace weave::loomlink::testing {

using weave::testing::Random;

namespace {

/// What writers were told, and what readers must then see: each request at most once, and all that was acknowledged.
struct Told {
    std::mutex mutex;
    std::vector<std::string> acknowledged;
    std::size_t not_seen = 0;  ///< acknowledged, and yet not in the next view
    std::atomic<std::size_t> count = 0, doubtful = 0;
};

/// One request: a record and its answer, and an object where there are bytes; done once however often it is repeated.
Status request(Store& store, const std::string& id, const std::string& bytes = {}) {
    return store.commit([&](Writer& writer) -> Status {
        WEAVE_TRY(const auto known, writer.answer(id, 1));
        if (known) return {};
        Statement statement = statement_of(1);
        statement.request = id;
        WEAVE_CHECK_OK(writer.append(statement));
        if (!bytes.empty()) WEAVE_CHECK_OK(writer.put_object(bytes));
        return writer.record_answer(id, 1, "done");
    });
}

/// Asks for one thing after the other until it is told to stop, each until it is acknowledged; so long it is repeated.
void work(Store& store, Told& told, const std::string& name, const std::atomic<bool>& stop) {
    for (int k = 0; !stop; ++k) {
        const std::string id = name + "-" + std::to_string(k);
        bool done = false;
        while (!stop && !done) {
            done = static_cast<bool>(request(store, id));
            if (!done) ++told.doubtful, ::usleep(5000);
        }
        if (!done) return;
        const auto seen = store.read([&](const Reader& reader) { return reader.answer(id, 1); });
        const std::lock_guard lock(told.mutex);
        told.acknowledged.push_back(id);
        if (seen && !*seen) ++told.not_seen;
        ++told.count;
    }
}

/// How often each request stands in the log.
std::map<std::string, int> requests_in(const std::string& place) {
    std::map<std::string, int> found;
    const Status looked = look_into(place, [&](const Reader& reader) -> Status {
        WEAVE_TRY(const auto events, reader.events({.from = 0, .most = 10'000'000, .kind = {}, .subject = {}}));
        for (const auto& [seq, bytes] : events) {
            WEAVE_TRY(const EventRecord record, parse_record(bytes));
            ++found[record.statement.request];
        }
        return {};
    });
    INFO(text_of(looked));
    REQUIRE(looked);
    return found;
}

std::size_t lost_of(const std::vector<std::string>& acknowledged, const std::map<std::string, int>& found) {
    return static_cast<std::size_t>(
        std::count_if(acknowledged.begin(), acknowledged.end(), [&](const std::string& id) { return !found.contains(id); }));
}

void wait_for(const std::function<bool()>& what) {
    for (int waits = 0; waits < 3000; ++waits) {
        if (what()) return;
        ::usleep(10'000);
    }
    FAIL("nothing came of it in half a minute");
}

void wait_for_synchronous(const PostgresServer& primary) {
    wait_for([&] { return primary.number("SELECT count(*) FROM pg_stat_replication WHERE sync_state = 'sync'") == 1; });
}

/// A primary with a synchronous standby, both of which change with each failover.
struct Pair {
    std::unique_ptr<PostgresServer> primary, standby;
    std::string database;

    /// With `flushed` it writes to the disk as it would in earnest.
    explicit Pair(bool flushed = false) : primary(std::make_unique<PostgresServer>()), database(primary->make_database()) {
        if (flushed) primary->configure("fsync = on"), primary->stop(), primary->start();
        Store made = got(Store::create(primary->place(database), "mill"));
        got(made.write([](Writer& writer) -> Result<Id> {
            WEAVE_TRY(const Seq event, note(writer));
            return writer.add_person({0, "anna", "Anna", true, "hash", {}, event});
        }));
        follow();
        if (flushed) standby->configure("fsync = on"), standby->stop(), standby->start(), wait_for_synchronous(*primary);
    }
    /// Gives the primary a fresh standby, and has it wait for that.
    void follow() {
        standby = std::make_unique<PostgresServer>(*primary, "mill_standby");
        primary->configure("synchronous_standby_names = 'FIRST 1 (mill_standby)'");
        primary->reload();
        wait_for_synchronous(*primary);
    }
    /// The runbook: the old primary is gone for good, the standby takes over and waits for nobody.
    void promote() {
        primary = std::move(standby);
        primary->configure("synchronous_standby_names = ''");
        primary->promote();
        primary->reload();
    }
    [[nodiscard]] std::string both() const { return primary->place_with(*standby, database); }
};

/// One kill at a random moment under load.
void fail_over(Pair& pair, Random& random, const std::string& round, Told& told) {
    std::atomic<bool> stop = false;
    std::vector<std::thread> writers;
    {
        Store store = got(Store::open(pair.both(), pair.standby->place(pair.database)));
        for (const char* name : {"a", "b", "c"})
            writers.emplace_back([&, who = round + name] { work(store, told, who, stop); });
        const std::size_t before = told.count, doubtful = told.doubtful;
        wait_for([&] { return told.count > before + 10; });
        ::usleep(static_cast<useconds_t>(random.between(0, 50'000)));
        pair.primary->kill();
        const std::size_t at_kill = told.count;
        wait_for([&] { return told.doubtful > doubtful; });  // it struck in mid-stream
        pair.promote();
        wait_for([&] { return told.count > at_kill + 10; });  // and the same program goes on
        stop = true;
        for (std::thread& writer : writers) writer.join();
    }
    const std::string place = pair.primary->place(pair.database);
    const auto found = requests_in(place);
    REQUIRE(lost_of(told.acknowledged, found) == 0);
    REQUIRE(told.not_seen == 0);
    for (const auto& [id, times] : found)
        if (id.find('-') != std::string::npos && id.starts_with("round")) REQUIRE(times == 1);
    REQUIRE(all_text(got(verify_store(place))) == "");
}

void fail_over_times(int rounds) {
    const std::uint64_t seed = weave::testing::run_seed();
    std::printf("seed %llu, %d kills of the primary\n", static_cast<unsigned long long>(seed), rounds);
    Random random(seed);
    Told told;
    Pair pair;
    for (int round = 0; round < rounds; ++round) {
        INFO("WEAVE_SEED=" << seed << ", kill " << round);
        fail_over(pair, random, "round" + std::to_string(round), told);
        if (round + 1 < rounds) pair.follow();
    }
    std::printf("%zu acknowledged requests, none lost, none done twice, each in the next view; %zu attempts were not acknowledged\n",
                told.acknowledged.size(), told.doubtful.load());
}

std::string random_bytes(Random& random, std::size_t size) {
    std::string bytes(size, ' ');
    for (char& byte : bytes) byte = static_cast<char>(random.between(0, 255));
    return bytes;
}

/// Takes all the room that is left on the disk of a file.
void fill_disk(const std::filesystem::path& file) {
    std::ofstream filler(file, std::ios::binary);
    const std::string block(65536, 'x');
    while (filler.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) continue;
}

/// Milliseconds of one request after the other, and of requests that eight ask for at once.
void measure(const std::string& name, Store& store) {
    constexpr int requests = 1000, together = 8;
    const auto time = [&](int threads) {
        const auto begin = std::chrono::steady_clock::now();
        std::vector<std::thread> all;
        for (int who = 0; who < threads; ++who)
            all.emplace_back([&, who] {
                for (int k = 0; k < requests / threads; ++k)
                    REQUIRE(request(store, name.substr(name.size() - 5) + std::to_string(threads) + "-" + std::to_string(who) + "-" + std::to_string(k)));
            });
        for (std::thread& one : all) one.join();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count() / requests;
    };
    const double alone = time(1), eight = time(together);
    std::printf("%-42s %6.2f ms a request, %6.2f ms where eight ask at once\n", name.c_str(), alone, eight);
}

}  // namespace

TEST_CASE("what a request costs on each kind of store", "[.][measure]") {
    if (there_is_no_server()) return;
    const Folder folder;
    Store file = got(Store::create(folder / "s.db", "mill"));
    got(file.write([](Writer& writer) -> Result<Id> {
        WEAVE_TRY(const Seq event, note(writer));
        return writer.add_person({0, "anna", "Anna", true, "hash", {}, event});
    }));
    measure("a file of SQLite", file);
    Pair pair(true);
    Store both = got(Store::open(pair.both()));
    measure("PostgreSQL with a synchronous standby", both);
    pair.standby->kill();
    pair.primary->configure("synchronous_standby_names = ''");
    pair.primary->reload();
    Store one = got(Store::open(pair.primary->place(pair.database)));
    measure("PostgreSQL alone", one);
}

TEST_CASE("kill -9 of the primary and promotion of its standby lose nothing that was acknowledged", "[server]") {
    if (there_is_no_server()) return;
    fail_over_times(3);
}

TEST_CASE("50 kills of the primary and promotions lose nothing that was acknowledged", "[.][long][server]") {
    if (there_is_no_server()) return;
    fail_over_times(50);
}

TEST_CASE("the failover test bites: behind a standby that is not waited for, acknowledged requests are lost", "[server]") {
    if (there_is_no_server()) return;
    Pair pair;
    pair.primary->configure("synchronous_standby_names = ''");
    pair.primary->reload();
    wait_for([&] { return pair.primary->number("SELECT count(*) FROM pg_stat_replication WHERE sync_state = 'sync'") == 0; });
    pair.standby->cut_off();
    std::vector<std::string> acknowledged;
    {
        Store store = got(Store::open(pair.primary->place(pair.database)));
        for (int k = 0; k < 200; ++k) {
            const std::string id = "round-" + std::to_string(k);
            if (request(store, id)) acknowledged.push_back(id);
        }
    }
    REQUIRE(acknowledged.size() == 200);
    pair.primary->kill();
    pair.promote();
    const std::size_t lost = lost_of(acknowledged, requests_in(pair.primary->place(pair.database)));
    std::printf("%zu of 200 acknowledged requests were lost without a synchronous standby\n", lost);
    CHECK(lost > 0);
}

TEST_CASE("a promoted standby that waits for nobody's standby is told, and goes on once the setting is cleared", "[server]") {
    if (there_is_no_server()) return;
    Pair pair;
    pair.standby->configure("synchronous_standby_names = 'FIRST 1 (mill_standby)'");  // as a standby inherits it
    pair.standby->reload();
    pair.primary->kill();
    pair.standby->promote();
    Store store = got(Store::open(pair.standby->place(pair.database)));
    const Status silent = request(store, "round-hang");
    REQUIRE_FALSE(silent);
    CHECK_THAT(silent.error().message, Catch::Contains("synchronous_standby_names") && Catch::Contains("repeat the request"));
    pair.standby->configure("synchronous_standby_names = ''");
    pair.standby->reload();
    wait_for([&] { return static_cast<bool>(request(store, "round-hang")); });
    CHECK(requests_in(pair.standby->place(pair.database)).at("round-hang") == 1);
}

TEST_CASE("a full disk of the server's write-ahead log is told and loses nothing that was acknowledged, and once there is room the store goes on", "[server]") {
    if (there_is_no_server()) return;
    PostgresServer server;
    const std::filesystem::path disk = server.move_log_to_small_disk();
    if (disk.empty()) WARN("skipped: no file system can be mounted here");
    if (disk.empty()) return;
    const std::string place = server.place(server.make_database());
    Store store = got(Store::create(place, "mill"));
    got(store.write([](Writer& writer) -> Result<Id> {
        WEAVE_TRY(const Seq event, note(writer));
        return writer.add_person({0, "anna", "Anna", true, "hash", {}, event});
    }));
    fill_disk(disk / "filler");
    std::vector<std::string> acknowledged;
    Status last;
    Random random(weave::testing::run_seed());
    for (int k = 0; last && k < 2000; ++k) {  // 200 MB, more than there is room for
        const std::string id = "full-" + std::to_string(k);
        last = request(store, id, random_bytes(random, 100'000));
        if (last) acknowledged.push_back(id);
    }
    REQUIRE_FALSE(last);
    CHECK(!acknowledged.empty());
    CHECK_THAT(text_of(last), Catch::Contains("the disk of the server's write-ahead log is full") && Catch::Contains("No space left on device") &&
                                  Catch::Contains("make room there"));
    CHECK_FALSE(store.last_write());
    // The server stays down, or comes back and goes down again, for its recovery has to write as well.
    wait_for([&] { return text_of(request(store, "later")).find("no connection to the server") != std::string::npos; });

    std::filesystem::remove(disk / "filler");
    server.stop();  // where it has not ended by itself
    server.start();
    CHECK(text_of(request(store, "later")) == "");
    acknowledged.emplace_back("later");
    const auto found = requests_in(place);
    CHECK(lost_of(acknowledged, found) == 0);
    for (const std::string& id : acknowledged) CHECK(found.at(id) == 1);
    CHECK(all_text(got(verify_store(place))) == "");
}

}  // namespace weave::loomlink::testing
