// kill -9 of the program itself, at random moments, while several people work through its API.

#include "api_case.hpp"
#include "program.hpp"
#include "store_case.hpp"

#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>

#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>
#include <support/random.hpp>
#include <thread>

namespace weave::loomlink::testing {

using weave::testing::Random;

namespace {

/// Something that a person asks for, and how it shows in the store once it was answered.
struct Wish {
    std::string who, path, kind;
    Json body;
    std::function<Result<bool>(const Reader&, const Json& answer)> shows{};
};
struct Promise {
    Wish wish;
    Json answer;
};

/// What all lanes tell the test.
struct Told {
    std::mutex mutex;
    std::vector<Promise> promises;
    std::vector<std::string> wrong;  ///< answers that nobody should get
    std::atomic<std::size_t> count{0};

    void keep(Promise promise) {
        const std::lock_guard lock(mutex);
        promises.push_back(std::move(promise));
        ++count;
    }
    void complain(std::string what) {
        const std::lock_guard lock(mutex);
        wrong.push_back(std::move(what));
        ++count;
    }
};

Result<std::optional<Revision>> revision_of(const Reader& reader, const std::string& design,
                                            std::int64_t number) {
    WEAVE_TRY(const auto found, reader.design(design));
    if (!found) return std::optional<Revision>();
    return reader.revision(found->id, number);
}

/// One client: its design goes from a saved revision to a release on its loom, and over again. A wish that
/// was not answered is asked again, as it was, until it is.
class Lane {
  public:
    Lane(std::string design, std::string loom, std::map<std::string, std::string> tokens)
        : m_design(std::move(design)), m_loom(std::move(loom)), m_tokens(std::move(tokens)) {}

    /// Works until the program is gone.
    void work(std::uint16_t port, Told& told) {
        net::ClientOptions options;
        options.port = port;
        net::HttpClient client(options);
        while (true) {
            if (!m_wish) m_wish = next();
            const auto answer = client.send(request_of(*m_wish));
            if (!answer) return;
            const std::string text = answer->body ? *answer->body : "";
            const auto json = parse_json(text);
            if (answer->status != 200 || !json)
                return told.complain(m_wish->path + ": " + std::to_string(answer->status) + " " + text);
            if (m_step == 0) m_revision = json->value("number", std::int64_t{0});
            if (m_step == last_step) m_release = json->value("number", std::int64_t{0});
            told.keep({*m_wish, *json});
            m_wish.reset();
            m_step = (m_step + 1) % (last_step + 1);
        }
    }

  private:
    static constexpr int last_step = 4;

    [[nodiscard]] net::ClientRequest request_of(const Wish& wish) const {
        return {"POST", std::string(api_root) + wish.path,
                net::Headers{{"Authorization", "Bearer " + m_tokens.at(wish.who)},
                             {"Content-Type", "application/json"}},
                wish.body.dump()};
    }

    Wish next() {
        const std::string path = "/designs/" + m_design + "/revisions/" + std::to_string(m_revision);
        Json why{{"reason", "It is good"}, {"password", api_password}};
        why["request"] = m_design + "-request-" + std::to_string(++m_requests);
        switch (m_step) {
            case 0:
                return save(why.at("request"));
            case 1:
                return comment(path, why.at("request"));
            case 2:
                why["looms"] = Json::array({m_loom});
                return step("dora", path + "/submit", "revision.submitted", why, RevisionState::submitted);
            case 3:
                return step("abel", path + "/approve", "revision.approved", why, RevisionState::approved);
            default:
                return release(why);
        }
    }

    Wish save(const std::string& request) const {
        weave::Design design = find_sample("twill-2-2")->make();
        design.title = m_design + " " + request;
        const std::string document = write_document(design);
        Json body{{"request", request}, {"document", document}, {"branch", "main"}, {"message", request}};
        if (m_revision > 0) body["expected"] = m_revision;
        return {"dora", "/designs/" + m_design + "/revisions", "revision.saved", body,
                [name = m_design, document](const Reader& reader, const Json& answer) -> Result<bool> {
                    WEAVE_TRY(const auto found, revision_of(reader, name, answer.at("number")));
                    if (!found || hash_hex(found->hash) != answer.at("sha256").get<std::string>())
                        return false;
                    WEAVE_TRY(const auto bytes, reader.object(found->document));
                    return bytes == document;
                }};
    }
    Wish comment(const std::string& path, const std::string& request) const {
        const Json body{{"request", request}, {"text", request}, {"pick", 1}, {"end", 1}};
        return {"dora", path + "/comment", "revision.commented", body,
                [name = m_design, number = m_revision, request](const Reader& reader,
                                                                const Json&) -> Result<bool> {
                    WEAVE_TRY(const auto found, revision_of(reader, name, number));
                    if (!found) return false;
                    WEAVE_TRY(const auto comments, reader.comments(found->id));
                    return std::count_if(comments.begin(), comments.end(),
                                         [&](const Comment& one) { return one.text == request; }) == 1;
                }};
    }
    Wish step(const std::string& who, const std::string& path, const std::string& kind, const Json& body,
              RevisionState state) const {
        return {
            who, path, kind, body,
            [name = m_design, number = m_revision, state](const Reader& reader, const Json&) -> Result<bool> {
                WEAVE_TRY(const auto found, revision_of(reader, name, number));
                if (!found) return false;
                WEAVE_TRY(const auto steps, reader.revision_steps(found->id));
                return std::count_if(steps.begin(), steps.end(),
                                     [&](const auto& one) { return one.state == state; }) == 1;
            }};
    }
    Wish release(Json body) const {
        body.update({{"design", m_design},
                     {"revision", m_revision},
                     {"loom", m_loom},
                     {"feeders", Json::array({1})}});
        if (m_release > 0) body["supersedes"] = m_release;
        return {"abel", "/releases", "release.made", body,
                [loom = m_loom](const Reader& reader, const Json& answer) -> Result<bool> {
                    WEAVE_TRY(const auto found, reader.loom(loom));
                    if (!found) return false;
                    WEAVE_TRY(const auto releases, reader.releases(found->id));
                    const auto made = std::find_if(releases.begin(), releases.end(), [&](const Release& one) {
                        return one.number == answer.at("number");
                    });
                    if (made == releases.end() || made->state == ReleaseStage::prepared) return false;
                    for (const ReleaseFile& file : made->files) {
                        WEAVE_TRY(const auto bytes, reader.object(file.object));
                        if (!bytes) return false;
                    }
                    return true;
                }};
    }

    std::string m_design, m_loom;
    std::map<std::string, std::string> m_tokens;
    std::int64_t m_revision = 0, m_release = 0;
    int m_step = 0, m_requests = 0;
    std::optional<Wish> m_wish;
};

/// How often each request led to a record of each kind.
using Deeds = std::map<std::pair<std::string, std::string>, std::size_t>;

Result<Deeds> deeds_of(const Reader& reader) {
    WEAVE_TRY(const auto events, reader.events({.from = 0, .most = 1000000, .kind = {}, .subject = {}}));
    Deeds deeds;
    for (const auto& [seq, bytes] : events) {
        WEAVE_TRY(const EventRecord record, parse_record(bytes));
        ++deeds[{record.statement.request, record.statement.kind}];
    }
    return deeds;
}

/// Whether a promise is kept: its record stands once, its answer is known, and what it was about is there.
Result<bool> kept(const Reader& reader, const Deeds& deeds, const Promise& promise) {
    const std::string request = promise.wish.body.at("request");
    const auto deed = deeds.find({request, promise.wish.kind});
    if (deed == deeds.end() || deed->second != 1) return false;
    WEAVE_TRY(const auto person, reader.person(promise.wish.who));
    if (!person) return false;
    WEAVE_TRY(const auto answer, reader.answer(request, person->id));
    if (!answer || parse_json(*answer).value().at("answer") != promise.answer) return false;
    return promise.wish.shows(reader, promise.answer);
}

/// What was promised and is not in the store, in words; and what stands there twice.
std::string broken(const Store& store, const std::vector<Promise>& promises) {
    std::string text;
    const Status looked = store.view([&](const Reader& reader) -> Status {
        WEAVE_TRY(const Deeds deeds, deeds_of(reader));
        for (const Promise& promise : promises) {
            WEAVE_TRY(const bool holds, kept(reader, deeds, promise));
            if (!holds) text += promise.wish.path + " " + promise.wish.body.at("request").dump() + "\n";
        }
        for (const auto& [deed, count] : deeds)
            if (count > 1 && deed.first.find("-request-") != std::string::npos)
                text += deed.first + " did " + deed.second + " " + std::to_string(count) + " times\n";
        return {};
    });
    return looked ? text : looked.error().text();
}

/// A site whose program is killed, and the people who go on all the same.
class KilledMill {
  public:
    KilledMill() : m_mill(true) {
        m_mill.people_and_a_loom();
        const std::string profile = read_file(WEAVE_SOURCE_DIR "/db/looms/tc2.json").value();
        for (const std::string name : {"cloth", "linen", "shoe"}) {
            m_mill.done("mary", "POST", "/looms", {{"name", "for " + name}, {"profile", profile}});
            m_mill.done("dora", "POST", "/designs", {{"name", name}});
            m_lanes.emplace_back(name, "for " + name, m_mill.tokens);
        }
        m_mill.site.reset();  // from here on the program serves it
    }

    /// Starts the program, kills it, and looks at what it leaves.
    void kill_once(Random& random) {
        Program program({"serve", site(), "--plain", "--port", "0", "--json"}, told_to_people());
        if (random.between(0, 7) == 0) {  // as it starts
            ::usleep(static_cast<useconds_t>(random.between(0, 60'000)));
            program.end(SIGKILL);
        } else {
            kill_at_work(program, random);
        }
        REQUIRE(program.exit_code() == -1);
        INFO(read_file(told_to_people()).value());
        REQUIRE(m_told.wrong == std::vector<std::string>());
        const Store store = Store::open(path()).value();
        REQUIRE(broken(store, m_told.promises).empty());
        REQUIRE(all_text(verify_store(path()).value()).empty());
    }
    [[nodiscard]] std::size_t acknowledged() const { return m_told.promises.size(); }

  private:
    void kill_at_work(Program& program, Random& random) {
        const auto started = parse_json(program.line());
        REQUIRE(started);
        const std::string url = started->at("url");
        const auto port = net::parse_origin(url).value().port;
        const std::size_t before = m_told.count;
        std::vector<std::thread> clients;
        for (Lane& lane : m_lanes) clients.emplace_back([&] { lane.work(port, m_told); });
        for (int waits = 0; m_told.count == before && waits < 60'000; ++waits) ::usleep(1000);
        ::usleep(static_cast<useconds_t>(random.between(0, 100'000)));
        program.end(SIGKILL);
        for (std::thread& client : clients) client.join();
        REQUIRE(m_told.count > before);
    }
    [[nodiscard]] std::string site() const { return m_mill.folder.path / "site"; }
    [[nodiscard]] std::string told_to_people() const { return m_mill.folder.path / "told.txt"; }
    [[nodiscard]] std::string path() const { return SiteFolder{site()}.store().value(); }

    ApiMill m_mill;
    std::vector<Lane> m_lanes;
    Told m_told;
};

/// Every 25 kills begin with a new site, so that none grows long.
void kill_the_program(std::size_t rounds) {
    const std::uint64_t seed = weave::testing::run_seed();
    std::printf("seed %llu, %zu kills of the program\n", static_cast<unsigned long long>(seed), rounds);
    Random random(seed);
    std::size_t acknowledged = 0;
    std::unique_ptr<KilledMill> mill;
    for (std::size_t round = 0; round < rounds; ++round) {
        if (round % 25 == 0) {
            acknowledged += mill ? mill->acknowledged() : 0;
            mill = std::make_unique<KilledMill>();
        }
        INFO("WEAVE_SEED=" << seed << ", kill " << round);
        mill->kill_once(random);
    }
    acknowledged += mill->acknowledged();
    std::printf("%zu acknowledged requests, none lost, none done twice\n", acknowledged);
    REQUIRE(acknowledged > rounds);
}

}  // namespace

TEST_CASE("kill -9 of the program takes back nothing that anybody was told, and does nothing twice") {
    kill_the_program(20);
}

TEST_CASE("1,000 kills of the program take back nothing that anybody was told", "[.][long]") {
    kill_the_program(1000);
}

}  // namespace weave::loomlink::testing
