// A disk that fails at every write of a whole story: a clean error each time, and the same request goes
// through afterwards, once.

#include "flow_case.hpp"

#include <functional>
#include <support/fault_vfs.hpp>
#include <support/random.hpp>

namespace weave::loomlink::testing {

using weave::testing::DiskFault;
using weave::testing::FaultDisk;
using weave::testing::Random;

namespace {

/// One request of the story, which says the same each time it is asked.
struct Request {
    const char* name;
    std::function<Status(FlowSite&, const Ask&)> run;
    const char* signer = "";
};

template <class T>
Status status_of(const Result<T>& result) {
    return result ? Status() : Status(result.error());
}

Request save_request(const char* title, std::optional<std::int64_t> expected) {
    return {title, [title, expected](FlowSite& site, const Ask& ask) {
                return status_of(site.flow->designs().save(
                    site.people.at("dora"), ask,
                    {"shoe", "main", title, FlowSite::document(title), expected, {}}));
            }};
}
Request submit_request(std::int64_t number) {
    return {"submit",
            [number](FlowSite& site, const Ask& ask) {
                return status_of(
                    site.flow->steps().submit(site.people.at("dora"), ask, {"shoe", number, "ready"}, {}));
            },
            "dora"};
}
Request approve_request(std::int64_t number) {
    return {"approve",
            [number](FlowSite& site, const Ask& ask) {
                return status_of(
                    site.flow->steps().approve(site.people.at("abe"), ask, {"shoe", number, "good"}));
            },
            "abe"};
}
Request release_request(std::int64_t number, std::optional<std::int64_t> supersedes) {
    return {"release",
            [number, supersedes](FlowSite& site, const Ask& ask) {
                return status_of(site.flow->releases().release(
                    site.people.at("abe"), ask, {"shoe", number, "EP 1", {1}, supersedes, "for spring"}));
            },
            "abe"};
}

/// From nothing to a recalled release, with everybody's part in it.
std::vector<Request> first_half() {
    return {
        {"design",
         [](FlowSite& site, const Ask& ask) {
             return status_of(site.flow->designs().add(site.people.at("dora"), ask, "shoe"));
         }},
        save_request("first", {}),
        {"comment",
         [](FlowSite& site, const Ask& ask) {
             return status_of(
                 site.flow->steps().comment(site.people.at("eve"), ask, {"shoe", 1, "narrow"}, 1, 1));
         }},
        submit_request(1),
        {"changes",
         [](FlowSite& site, const Ask& ask) {
             return status_of(
                 site.flow->steps().request_changes(site.people.at("abe"), ask, {"shoe", 1, "wider"}));
         },
         "abe"},
        save_request("second", 1),
        submit_request(2),
        {"waive",
         [](FlowSite& site, const Ask& ask) {
             return status_of(site.flow->steps().waive(site.people.at("abe"), ask, {"shoe", 2, "seen"},
                                                       "float.face", "EP 1"));
         },
         "abe"},
        approve_request(2),
        release_request(2, {}),
    };
}
std::vector<Request> second_half() {
    return {
        {"look",
         [](FlowSite& site, const Ask&) {
             return status_of(site.flow->releases().read(site.people.at("otto"), "EP 1", 1));
         }},
        {"pull",
         [](FlowSite& site, const Ask&) {
             return status_of(site.flow->releases().manifest(site.people.at("otto"), "EP 1", 1));
         }},
        {"index",
         [](FlowSite& site, const Ask&) {
             return status_of(site.flow->releases().index(site.people.at("otto"), "EP 1", 1, 0));
         }},
        {"loaded",
         [](FlowSite& site, const Ask& ask) {
             return status_of(site.flow->looms().confirm_loaded(site.people.at("otto"), ask, "EP 1", 1));
         }},
        {"place",
         [](FlowSite& site, const Ask& ask) {
             return status_of(site.flow->looms().keep_place(site.people.at("otto"), ask, "EP 1", 1, 3));
         }},
        {"fault",
         [](FlowSite& site, const Ask& ask) {
             return status_of(
                 site.flow->looms().report_fault(site.people.at("otto"), ask, "EP 1", 1, "it floats", 2, 1));
         }},
        save_request("third", 2),
        submit_request(3),
        approve_request(3),
        release_request(3, 1),
        {"head", [](FlowSite& site,
                    const Ask&) { return status_of(site.flow->audit().head(site.people.at("enno"))); }},
        {"withdraw",
         [](FlowSite& site, const Ask& ask) {
             return status_of(
                 site.flow->releases().withdraw(site.people.at("enno"), ask, "EP 1", 2, "wrong"));
         },
         "enno"},
    };
}
std::vector<Request> story() {
    std::vector<Request> requests = first_half();
    for (Request& request : second_half()) requests.push_back(std::move(request));
    return requests;
}

/// What a story left: all rows, and what the log says happened, in order.
struct Left {
    std::string rows;
    std::vector<std::string> kinds;
    std::size_t failed = 0;
};

/// Tells the story from the beginning on a disk on which call number `at` goes wrong.
class Teller {
  public:
    Teller() {
        m_site.set_policy();
        m_site.set_up_loom();
        m_site.flow.reset();
        std::filesystem::copy_file(m_site.path, m_begin);
    }

    Left tell(FaultDisk& disk, DiskFault fault, std::uint64_t at) {
        m_site.flow.reset();
        for (const char* more : {"-wal", "-shm"}) std::filesystem::remove(m_site.path + more);
        std::filesystem::copy_file(m_begin, m_site.path, std::filesystem::copy_options::overwrite_existing);
        m_site.open();
        Left left;
        disk.plan(fault, at);
        int number = 0;
        for (const Request& request : story()) {
            const Ask ask{"story-request-" + std::to_string(++number),
                          *request.signer == '\0' ? "" : FlowSite::password(request.signer)};
            left.failed += failed_first(request, ask) ? 1 : 0;
        }
        m_happened = disk.happened();
        disk.plan(DiskFault::none, 0);
        left.rows = m_site.dump();
        left.kinds = m_site.kinds(0);
        m_site.flow.reset();
        REQUIRE(all_text(verify_store(m_site.path).value()).empty());
        return left;
    }
    [[nodiscard]] bool happened() const { return m_happened; }

  private:
    /// Asks; where the disk fails, the error is the system's, and the same request is then done.
    bool failed_first(const Request& request, const Ask& ask) {
        INFO(request.name);
        const Status first = request.run(m_site, ask);
        if (first) return false;
        INFO(first.error().text());
        REQUIRE(first.error().code == ErrorCode::system);
        const Status second = request.run(m_site, ask);
        INFO(text_of(second));
        REQUIRE(second);
        return true;
    }

    FlowSite m_site;
    std::filesystem::path m_begin = m_site.folder / "begin.db";
    bool m_happened = false;
};

/// Lets every `stride`-th call of the story fail, from a random one on.
void fail_at_writes(std::size_t stride) {
    const std::uint64_t seed = weave::testing::run_seed();
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
    Random random(seed);
    FaultDisk disk;
    Teller teller;
    const Left undisturbed = teller.tell(disk, DiskFault::none, 0);
    for (const DiskFault fault : {DiskFault::full, DiskFault::io_error, DiskFault::short_write}) {
        std::size_t tried = 0, failed = 0;
        for (std::uint64_t at = random.between(1, stride);; at += stride) {
            INFO("WEAVE_SEED=" << seed << ", fault " << static_cast<int>(fault) << " at call " << at);
            const Left left = teller.tell(disk, fault, at);
            if (!teller.happened()) break;
            REQUIRE(left.failed <= 1);
            REQUIRE(left.kinds == undisturbed.kinds);
            REQUIRE(left.rows == undisturbed.rows);
            ++tried, failed += left.failed;
        }
        std::printf("fault %d: at %zu calls of the disk; %zu requests failed, and were done when repeated\n",
                    static_cast<int>(fault), tried, failed);
        REQUIRE(failed > 0);
    }
}

}  // namespace

TEST_CASE("a disk that fails somewhere in a story costs one clean error, and the request repeated is done once", "[file]") {
    fail_at_writes(25);
}

TEST_CASE("a disk that fails at any write of a story costs one clean error at most", "[.][long][file]") {
    fail_at_writes(1);
}

}  // namespace weave::loomlink::testing
