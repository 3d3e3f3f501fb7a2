#include "commands_case.hpp"

#include <algorithm>
#include <chrono>
#include <loomlink/keys/release_manifest.hpp>
#include <support/random.hpp>
#include <thread>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::for_all;
using weave::testing::Random;

namespace fs = std::filesystem;

namespace {

/// Folders of releases below a loom's folder; a file whose name begins with a point is none.
std::vector<fs::path> release_folders(const fs::path& loom) {
    std::vector<fs::path> list;
    std::error_code code;
    for (fs::directory_iterator entry(loom, code), end; !code && entry != end; entry.increment(code))
        if (!entry->path().filename().string().starts_with('.')) list.push_back(entry->path());
    return list;
}

/// Waits for what another program does, as long as that takes; gives up after two minutes.
template <class What>
bool comes_true(What what) {
    for (int k = 0; k < 2400 && !what(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return what();
}

Ended verify(const CommandMill& mill, const fs::path& folder) {
    return mill.run({"verify-files", folder, "--state", mill.at("state"), "--json"});
}

/// The first file of a release beside its manifest.
fs::path some_file(const fs::path& folder) {
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().filename() != manifest_name) return entry.path();
    FAIL("the release has no file");
    return {};
}

}  // namespace

TEST_CASE("a loom pulls what was released, finds what was altered, and gives up what was recalled",
          "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    const Ended unknown = mill.run(mill.pull_words());
    CHECK(unknown.code == 2);
    CHECK_THAT(unknown.err, Catch::Contains("--trust"));
    const Ended false_trust = mill.run(mill.pull_words({"--trust", std::string(64, 'a')}));
    CHECK(false_trust.code == 4);
    const Ended no_trust = mill.run(mill.pull_words({"--trust", "1234"}));
    CHECK(no_trust.code == 3);
    CHECK_THAT(no_trust.err,
               Catch::Contains("--trust: must be 64") && Catch::Contains("loomlink trust show"));
    CHECK(release_folders(mill.at("loom")).empty());

    const std::string held_trust = mill.trust_fingerprint();
    const Ended pulled = mill.run(mill.pull_words({"--trust", held_trust}));
    INFO(pulled.err);
    REQUIRE(pulled.code == 0);
    const Json held = pulled.json().at("releases").at(0);
    CHECK(held.at("new") == true);
    const fs::path folder = held.at("folder").get<std::string>();
    CHECK(mode_of(mill.at("state")) == 0600);
    CHECK(mill.run(mill.pull_words({"--all"})).json().at("releases").at(0).at("new") == false);
    CHECK(mill.run(mill.pull_words({"--release", "9"})).code == 4);
    CHECK(mill.as("emil", {"pull", "eight", "--to", mill.at("loom"), "--state", mill.at("state")}).code == 4);

    CHECK(verify(mill, folder).code == 0);
    mill.done("mary", {"trust", "show", "-o", mill.at("trust.json")});
    const auto by_paper = [&](const std::string& loom = "seven") {
        return mill.run({"verify-files", folder, "--trust", mill.at("trust.json"), "--fingerprint", held_trust, "--loom", loom, "--json"});
    };
    CHECK(by_paper().code == 0);
    const Ended elsewhere = by_paper("eight");
    CHECK(elsewhere.code == 4);
    CHECK_THAT(elsewhere.json().at("may_not_be_woven").get<std::string>(), Catch::Contains("is for the loom 'seven', not for 'eight'"));
    const Ended unheard = mill.run({"verify-files", folder, "--trust", mill.at("trust.json"), "--fingerprint", std::string(64, 'a')});
    CHECK(unheard.code == 1);
    CHECK_THAT(unheard.err, Catch::Contains("trust.json: has the fingerprint " + held_trust));
    std::string paper = read_file(mill.at("trust.json")).value();
    char& digit = paper[paper.find("\"value\":\"") + 9];
    digit = digit == '0' ? '1' : '0';
    REQUIRE(write_file(mill.at("trust.json"), paper));
    const Ended false_paper = by_paper();
    CHECK(false_paper.code == 1);
    CHECK(false_paper.json().at("error").at("kind") == "invalid");
    const fs::path file = some_file(folder);
    flip(file, 0);
    const Ended altered = verify(mill, folder);
    CHECK(altered.code == 1);
    CHECK(altered.json().at("findings").at(0).at("file") == file.filename().string());
    const Ended left = mill.run(mill.pull_words());  // not written over: a person has to look
    CHECK(left.code == 1);
    CHECK(left.json().at("error").at("kind") == "invalid");
    flip(file, 0);
    REQUIRE(write_file(folder / "more.txt", "more"));
    CHECK(verify(mill, folder).json().at("findings").at(0).at("trouble") == "too many");
    fs::remove(folder / "more.txt");
    flip(folder / manifest_name, read_file(folder / manifest_name).value().find("\"picks\":") + 8);
    const Ended forged = verify(mill, folder);
    CHECK(forged.code == 1);
    CHECK(forged.json().at("error").at("kind") == "invalid");
    CHECK_THAT(forged.err, Catch::Contains("manifest.json") && Catch::Contains("forged or altered"));
    flip(folder / manifest_name, read_file(folder / manifest_name).value().find("\"picks\":") + 8);
    CHECK(verify(mill, folder).code == 0);

    mill.signs("emil", {"withdraw", "seven", "1"});
    fs::copy(folder, mill.at("kept"), fs::copy_options::recursive);
    const Ended recalled = mill.run(mill.pull_words());
    CHECK(recalled.code == 0);
    CHECK_FALSE(recalled.json().at("removed").empty());
    CHECK_FALSE(fs::exists(folder));
    const Ended kept = verify(mill, mill.at("kept"));
    CHECK(kept.code == 4);
    CHECK(kept.json().at("error").at("kind") == "refused");
    CHECK(kept.json().at("may_not_be_woven").is_string());
    CHECK_THAT(kept.err, Catch::Contains("must not be woven"));
    CHECK(mill.run(mill.pull_words({"--release", "1"})).code == 4);
}

TEST_CASE("a terminal that trusts one mill says so where --trust names another and changes nothing", "[commands]") {
    const CommandMill trial, real;
    trial.set_up();
    real.set_up();
    const std::string first = trial.trust_fingerprint(), other = real.trust_fingerprint();
    REQUIRE(trial.run(trial.pull_words({"--trust", first})).code == 0);
    const std::string state = read_file(trial.at("state")).value();
    real.put_private("state", state);  // one file for both, as for two mills with a loom of one name
    const Ended mixed = real.run(real.pull_words({"--trust", other}));
    CHECK(mixed.code == 4);
    for (const std::string& told : {first, other, real.at("state").string(), std::string("--state")})
        CHECK_THAT(mixed.err, Catch::Contains(told));
    CHECK(read_file(real.at("state")).value() == state);
    CHECK_FALSE(fs::exists(real.at("loom")));
    CHECK(real.run(real.pull_words({"--trust", std::string(64, 'a')})).code == 4);
    CHECK(trial.run(trial.pull_words({"--trust", other})).code == 4);
    CHECK(read_file(trial.at("state")).value() == state);
    fs::rename(real.at("state"), real.at("state of the trial"));
    CHECK(real.run(real.pull_words({"--trust", other})).code == 0);

    // Older and newer documents of the same chain are the same mill.
    trial.invite("anna", {"approver"});
    trial.done("mary", {"trust", "publish"}, true);
    const std::string second = trial.trust_fingerprint();
    REQUIRE(second != first);
    for (const std::string& fingerprint : {second, first, second}) {
        const Ended again = trial.run(trial.pull_words({"--trust", fingerprint}));
        INFO(again.err);
        CHECK(again.code == 0);
    }
}

TEST_CASE("what could not be had hides no recall and keeps nothing else from coming", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    REQUIRE(mill.run(mill.pull_words({"--trust", mill.trust_fingerprint()})).code == 0);
    const fs::path first = release_folders(mill.at("loom")).at(0);
    REQUIRE(write_file(first / "notes.txt", "mine"));
    mill.save("plain");
    mill.approve("2");
    mill.release("2", {"--supersedes", "1"});
    mill.done("mary", {"policy", "--release-signatures", "2"});
    mill.done("mary", {"trust", "publish"}, true);
    const Ended pulled = mill.run(mill.pull_words());
    const Json told = pulled.json();
    INFO(pulled.out << pulled.err);
    CHECK(told.at("refused").at(0).at("number") == 2);
    CHECK_THAT(pulled.err, Catch::Contains("people who must sign"));
    CHECK(told.at("superseded").size() > 0);
    CHECK(told.at("kept").at(0).at("file").get<std::string>().ends_with("notes.txt"));
    CHECK(pulled.code == 1);
    CHECK(fs::exists(first / "notes.txt"));
}

TEST_CASE("what was superseded leaves the loom once its successor lies there; two pulls take turns",
          "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    REQUIRE(mill.run(mill.pull_words({"--trust", mill.trust_fingerprint()})).code == 0);
    mill.save("plain");
    mill.approve("2");
    mill.release("2", {"--supersedes", "1"});
    Running one(mill.pull_words(), mill.folder.path), other(mill.pull_words(), mill.folder.path);
    CHECK(one.wait().code == 0);
    CHECK(other.wait().code == 0);
    const auto folders = release_folders(mill.at("loom"));
    REQUIRE(folders.size() == 1);
    CHECK_THAT(folders[0].filename().string(), Catch::StartsWith("release-2"));
}

TEST_CASE("a recall takes what was pulled into another folder, from wherever it is called", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    const auto pull_to = [&](const fs::path& to, const std::vector<std::string>& more = {}) {
        std::vector<std::string> words = mill.pull_words(more);
        *std::next(std::find(words.begin(), words.end(), "--to")) = to.string();
        return mill.run(words);
    };
    const Ended first = pull_to(fs::relative(mill.at("here")), {"--trust", mill.trust_fingerprint()});
    INFO(first.out << first.err);
    REQUIRE(first.code == 0);
    REQUIRE(pull_to(mill.at("there")).json().at("releases").at(0).at("new") == true);
    const fs::path here = release_folders(mill.at("here")).at(0), there = release_folders(mill.at("there")).at(0);
    fs::create_directory(mill.at("copy"));
    fs::copy(there, mill.at("copy") / there.filename(), fs::copy_options::recursive);
    mill.signs("abel", {"withdraw", "seven", "1"});
    const Ended recalled = pull_to(mill.at("third"));
    CHECK(recalled.code == 0);
    CHECK(recalled.json().at("removed").size() == 2 * std::size_t(std::distance(fs::directory_iterator(mill.at("copy") / there.filename()), {})));
    CHECK_FALSE(fs::exists(here));
    CHECK_FALSE(fs::exists(there));
    // Copied back in, it is no release of this terminal any more; each pull says so.
    fs::copy(mill.at("copy") / there.filename(), there, fs::copy_options::recursive);
    const Ended copied = pull_to(mill.at("there"));
    CHECK(copied.code == 1);
    CHECK(copied.json().at("kept").at(0).at("file") == there.string());
    CHECK_THAT(copied.json().at("kept").at(0).at("message").get<std::string>(), Catch::Contains("not put there by this terminal"));
}

TEST_CASE("a recalled file that somebody changed stays, is told, and the pull ends with 1", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    const Ended pulled = mill.run(mill.pull_words({"--trust", mill.trust_fingerprint()}));
    REQUIRE(pulled.code == 0);
    const fs::path file = some_file(pulled.json().at("releases").at(0).at("folder").get<std::string>());
    flip(file, 0);
    mill.signs("abel", {"withdraw", "seven", "1"});
    const Ended recalled = mill.run(mill.pull_words());
    CHECK(recalled.code == 1);
    CHECK(recalled.json().at("kept").size() == 1);
    CHECK(fs::exists(file));
}

TEST_CASE("a pull that is cut off at any moment leaves whole releases or none, and the next one ends it",
          "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    const std::string trust = mill.trust_fingerprint();
    const auto cut_off = [&](Random& random) {
        constexpr std::size_t longest_ms = 150;
        fs::remove_all(mill.at("loom"));
        fs::remove(mill.at("state"));
        Running pull(mill.pull_words({"--trust", trust}), mill.folder.path);
        std::this_thread::sleep_for(std::chrono::milliseconds(random.between(0, longest_ms)));
        pull.end(SIGKILL);
        pull.wait();
        for (const fs::path& folder : release_folders(mill.at("loom"))) CHECK(verify(mill, folder).code == 0);
    };
    for_all(cut_off, 30);
    const Ended last = mill.run(mill.pull_words({"--trust", trust}));
    INFO(last.err);
    REQUIRE(last.code == 0);
    const fs::path folder = last.json().at("releases").at(0).at("folder").get<std::string>();
    CHECK(verify(mill, folder).code == 0);
    CHECK(release_folders(mill.at("loom")).size() == 1);
}

TEST_CASE(
    "a watching loom takes what is released and drops what is recalled, through an outage and a lost session",
    "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    Running watch(mill.pull_words({"--trust", mill.trust_fingerprint(), "--all", "--watch", "--every", "2",
                                   "--password-file", mill.at("password")}),
                  mill.folder.path);
    const auto holds = [&](std::size_t number) {
        return [&, number] { return release_folders(mill.at("loom")).size() == number; };
    };
    mill.release("1");
    CHECK(comes_true(holds(1)));
    mill.signs("emil", {"withdraw", "seven", "1"});
    CHECK(comes_true(holds(0)));

    mill.stop();
    CHECK(comes_true([&] { return watch.told().find("trying on") != std::string::npos; }));
    mill.start();
    mill.done("otto", {"logout"});  // which leaves the watching one without its session
    mill.save("plain");
    mill.approve("2");
    mill.release("2");
    CHECK(comes_true(holds(1)));
    CHECK(watch.is_alive());
    CHECK(comes_true([&] { return watch.told().find("the server answers again") != std::string::npos; }));
    // A line for each change, and none for pulls that changed nothing.
    const std::string lines = watch.so_far();
    CHECK(std::count(lines.begin(), lines.end(), '\n') <= 5);
    CHECK(parse_json(lines.substr(0, lines.find('\n'))));
    watch.end(SIGTERM);
    watch.wait();
}

TEST_CASE("a watch whose call is wrong ends at once", "[commands]") {
    CommandMill mill;
    mill.set_up();
    CHECK(mill.run(mill.pull_words({"--watch", "--trust", std::string(64, 'b')})).code == 4);
    CHECK(mill.run(mill.pull_words({"--watch"})).code == 2);
    CHECK(mill.run(mill.pull_words({"--every", "5"})).code == 2);
    CHECK(mill.run(mill.pull_words({"--release", "1", "--all"})).code == 2);
}
