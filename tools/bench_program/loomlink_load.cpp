#include "flip_one.hpp"
#include "loomlink.hpp"
#include "loomlink_site.hpp"
#include "spread.hpp"

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>

#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace weave::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t operators = 200, designers = 20, seconds = 60;
constexpr std::size_t pulls_a_second = 40, saves_a_second = 2;
constexpr std::size_t saves_each = saves_a_second * seconds / designers;

/// Milliseconds of every request of a kind, and what went wrong.
class Times {
  public:
    void take(Clock::time_point planned, const std::string& trouble) {
        const double ms = std::chrono::duration<double, std::milli>(Clock::now() - planned).count();
        const std::lock_guard lock(m_mutex);
        m_ms.push_back(ms);
        if (trouble.empty()) return;
        ++m_errors;
        m_trouble = trouble;
    }
    [[nodiscard]] Json told() const {
        Json json = spread_ms(m_ms);
        json["errors"] = m_errors;
        if (m_errors > 0) json["last_error"] = m_trouble;
        return json;
    }

  private:
    std::mutex m_mutex;
    std::vector<double> m_ms;
    std::size_t m_errors = 0;
    std::string m_trouble;
};

/// A person, and what he or she will save: the same design, each time with one more crossing flipped.
struct Designer {
    LoomlinkSite::Person person;
    std::string design;
    std::vector<std::string> documents;
};

/// The site with everybody in it, a release of the shoe, and its file that the loom reads.
struct Mill {
    LoomlinkSite site;
    std::vector<LoomlinkSite::Person> at_looms;
    std::vector<Designer> at_desks;
    std::string path, bytes;

    Mill() {
        make_people();
        release_the_shoe();
    }

  private:
    void make_people() {
        auto& admin = site.administrator();
        const std::string profile = read_file(WEAVE_SOURCE_DIR "/db/looms/ep-2688.json").value();
        admin.done("POST", "/looms", {{"name", "seven"}, {"profile", profile}});
        Json names = Json::array();
        for (std::size_t k = 0; k < operators; ++k) {
            names.push_back("operator-" + std::to_string(k));
            at_looms.push_back(site.join(names.back(), "operator"));
        }
        admin.done("PUT", "/looms/seven/operators", {{"operators", names}});
        for (std::size_t k = 0; k < designers; ++k) {
            const std::string name = "designer-" + std::to_string(k);
            at_desks.push_back({site.join(name, "designer"), "shoe-" + std::to_string(k), {}});
        }
    }
    void release_the_shoe() {
        Design design = find_sample("shoe-adult")->make();
        const std::string document = write_document(design);
        for (Designer& designer : at_desks) {
            designer.person.done("POST", "/designs", {{"name", designer.design}});
            designer.person.done("POST", "/designs/" + designer.design + "/revisions",
                                 {{"document", document}, {"branch", "main"}, {"message", "the shoe"}});
        }
        for (std::size_t k = 0; k < saves_each * designers; ++k) {
            flip_one(design, k + 1);
            at_desks[k % designers].documents.push_back(write_document(design));
        }
        auto approver = site.join("approver", "approver");
        site.administrator().done("POST", "/trust", {{"password", LoomlinkSite::password}});
        const Json why{{"reason", "for the loom"}, {"password", LoomlinkSite::password}};
        at_desks[0].person.done("POST", "/designs/shoe-0/revisions/1/submit", why);
        approver.done("POST", "/designs/shoe-0/revisions/1/approve", why);
        Json wish = why;
        wish.update({{"design", "shoe-0"}, {"revision", 1}, {"loom", "seven"}, {"feeders", Json::array()}});
        for (std::size_t k = 1; k <= design.weft.feeders.size(); ++k) wish["feeders"].push_back(k);
        approver.done("POST", "/releases", wish);
        const Json release = at_looms[0].done("GET", "/looms/seven/releases/1");
        for (const Json& file : release.at("files"))
            if (file.at("name").get<std::string>().ends_with(".ep"))
                path = file.at("name").get<std::string>();
        path = "/looms/seven/releases/1/files/" + path;
        const auto pulled = at_looms[0].ask("GET", path);
        if (!pulled || pulled->status != 200) throw std::runtime_error("the loom file cannot be pulled");
        bytes = *pulled->body;
    }
};

std::string trouble_of(const Result<net::Response>& answer) {
    if (!answer) return answer.error().text();
    if (answer->status == 200) return {};
    return std::to_string(answer->status) + " " + (answer->body ? *answer->body : "");
}

void pull(const Mill& mill, LoomlinkSite::Person& person, Clock::time_point planned, Times& times) {
    const auto answer = person.ask("GET", mill.path);
    std::string trouble = trouble_of(answer);
    if (trouble.empty() && (!answer->body || *answer->body != mill.bytes))
        trouble = "other bytes than were released";
    times.take(planned, trouble);
}

void save(Designer& designer, std::size_t number, Clock::time_point planned, Times& times) {
    const Json body{{"document", designer.documents[number]},
                    {"branch", "main"},
                    {"expected", number + 1},
                    {"message", "one more crossing"}};
    times.take(planned,
               trouble_of(designer.person.ask("POST", "/designs/" + designer.design + "/revisions", body)));
}

/// All of them at once, each at the moments planned.
void run(Mill& mill, Times& pulls, Times& saves) {
    for (auto& person : mill.at_looms)
        person.done("GET", "/me");  // the connection stands before it is needed
    for (auto& designer : mill.at_desks) designer.person.done("GET", "/me");
    const auto start = Clock::now() + std::chrono::seconds(1);
    const auto planned = [&](std::size_t number, std::size_t a_second) {
        const auto moment = start + std::chrono::microseconds(number * 1'000'000 / a_second);
        std::this_thread::sleep_until(moment);
        return moment;
    };
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < operators; ++i)
        threads.emplace_back([&, i] {
            for (std::size_t k = i; k < pulls_a_second * seconds; k += operators)
                pull(mill, mill.at_looms[i], planned(k, pulls_a_second), pulls);
        });
    for (std::size_t i = 0; i < designers; ++i)
        threads.emplace_back([&, i] {
            for (std::size_t k = 0; k < saves_each; ++k)
                save(mill.at_desks[i], k, planned(k * designers + i, saves_a_second), saves);
        });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace

Json loomlink_load() {
    Mill mill;
    Times alone, pulls, saves;
    for (std::size_t k = 0; k < pulls_a_second; ++k) pull(mill, mill.at_looms[0], Clock::now(), alone);
    run(mill, pulls, saves);
    return {{"cores", std::thread::hardware_concurrency()},
            {"operators", operators},
            {"designers", designers},
            {"seconds", seconds},
            {"file_bytes", mill.bytes.size()},
            {"document_bytes", mill.at_desks[0].documents[0].size()},
            {"alone", alone.told()},
            {"pulls", pulls.told()},
            {"saves", saves.told()}};
}

}  // namespace weave::bench
