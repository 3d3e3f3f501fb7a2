#include "commands_case.hpp"

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

TEST_CASE("a call that makes no sense ends with 2 and says what is missing", "[commands]") {
    const TemporaryFolder folder;
    struct Call {
        std::vector<std::string> words;
        std::string says;
    };
    const std::vector<Call> calls{
        {{}, "name a command"},
        {{"weave"}, "there is no command 'weave'"},
        {{"--loud"}, "there is no option '--loud'"},
        {{"user"},
         "name what to do; user has list, invite, bootstrap, join, roles, disable, enable, reset "
         "and password"},
        {{"user", "bake"}, "there is no command 'bake' of user; user has list, invite"},
        {{"login", "--name", "dora"}, "say which server"},
        {{"login", "https://127.0.0.1:1"}, "say who you are"},
        {{"login", "https://127.0.0.1:1", "--name", "dora"}, "--password-file"},
        {{"login", "http://127.0.0.1:1", "--name", "d", "--fingerprint", std::string(64, 'a')}, "https://"},
        {{"user", "invite", "king"}, "king"},
        {{"approve", "cloth", "1"}, "--reason"},
        {{"approve", "cloth", "one", "--reason", "x"}, "'one' is not a whole number"},
        {{"approve", "cloth", "0", "--reason", "x"}, "'0' is not a whole number"},
        {{"release", "cloth", "1", "--loom", "x", "--reason", "x", "--feeders", "1,x"}, "'x' is not"},
        {{"save", "a.weave", "cloth"}, "--message"},
        {{"audit", "verify", "x"}, "--key, --state, or --trust with --fingerprint"},
        {{"audit", "verify", "x", "--key", "a", "--trust", "b"}, "--key, --state, or --trust with --fingerprint"},
        {{"verify-files", "x"}, "--loom, --state, or --trust with --fingerprint"},
        {{"verify-files", "x", "--trust", "a", "--state", "b"}, "--loom, --state, or --trust with --fingerprint"},
        {{"verify-files", "x", "--trust", "a"}, "--loom, --state, or --trust with --fingerprint"},
        {{"verify-files", "x", "--loom", "a", "--fingerprint", "1"}, "--loom, --state, or --trust with --fingerprint"},
        {{"audit", "verify", "x", "--trust", "b"}, "--key, --state, or --trust with --fingerprint"},
        {{"audit", "verify", "x", "--key", "a", "--fingerprint", "b"}, "--key, --state, or --trust with --fingerprint"},
        {{"log", "--from", "-1"}, "--from"},
        {{"design", "make", "a/b"}, "'a/b' is no name: it must be 1 to 64 of the letters a to z"},
        {{"design", "show", ".."}, "'..' is no name"},
        {{"submit", "", "1", "--reason", "x"}, "'' is no name"},
        {{"submit", "cloth", "1", "--reason", "x", "--loom", "a/b"}, "'a/b' is no name"},
        {{"diff", "../cloth", "1", "2"}, "'../cloth' is no name"},
        {{"save", "a.weave", "a b", "-m", "x"}, "'a b' is no name"},
        {{"release", "cloth", "1", "--loom", "..", "--reason", "x"}, "'..' is no name"},
        {{"loom", "show", ""}, "'' is no name"},
        {{"faults", "seven/../eight"}, "'seven/../eight' is no name"},
        {{"pull", "..", "--to", "x"}, "'..' is no name"},
        {{"withdraw", "a/b", "1", "--reason", "x"}, "'a/b' is no name"},
        {{"verify-files", "x", "--loom", "../x"}, "'../x' is no name"},
        {{"user", "disable", ".."}, "'..' is no name"},
        {{"signer", "revoke", "../x"}, "'../x' is no name"},
        {{"log", "--design", "a/b"}, "'a/b' is no name"},
        {{"serve", ""}, "FOLDER: must not be empty"},
        {{"comment", "cloth", "1", "gr\xfc" "n"}, "is not UTF-8"},
        {{"approve", "cloth", "1", "--reason", "gr\xfc" "n"}, "is not UTF-8"},
        {{"user", "invite", "weaver"}, "'weaver' is none of designer, approver, operator, engineer, admin"},
        {{"policy", "--coverage", "2"}, "'2' is no share from 0 to 1"},
        {{"policy", "--coverage", "half"}, "'half' is no share from 0 to 1"},
        {{"policy", "--fidelity", "fine"}, "'fine' is none of draft, standard, reference"},
        {{"submit", "cloth", "1", "--reason", ""}, "--reason: says nothing"},
        {{"approve", "cloth", "1", "--reason", "  "}, "--reason: says nothing"},
        {{"withdraw", "seven", "1", "-r", "\u200b"}, "--reason: says nothing"},
        {{"release", "cloth", "1", "--loom", "x", "--reason", "\u3000"}, "--reason: says nothing"},
        {{"save", "a.weave", "cloth", "--message", "   "}, "--message: says nothing"},
        {{"comment", "cloth", "1", "\t"}, "TEXT: says nothing"},
    };
    for (const Call& call : calls) {
        const Ended ended = Running(call.words, folder.path).wait();
        INFO((call.words.empty() ? "" : call.words.front()) << ": " << ended.err);
        CHECK(ended.code == 2);
        CHECK(ended.out.empty());
        CHECK_THAT(ended.err, Catch::Contains(call.says));
    }
}

TEST_CASE("a group without a command tells those that it has", "[commands]") {
    const TemporaryFolder folder;
    const std::vector<std::pair<std::string, std::string>> groups{
        {"design", "list, make and show"},      {"loom", "list, show, add, profile and operators"},
        {"trust", "show, pending and publish"}, {"key", "list, access and show"},
        {"audit", "head, bundle and verify"},   {"evidence", "add and list"}};
    for (const auto& [group, commands] : groups) {
        const Ended ended = Running({group, "--json"}, folder.path).wait();
        INFO(group << ": " << ended.err);
        CHECK(ended.code == 2);
        const Json error = ended.json().at("error");
        CHECK(error.at("kind") == "usage");
        CHECK(error.at("message") == "name what to do; " + group + " has " + commands);
    }
}

TEST_CASE("every command explains itself with an example or in words", "[commands]") {
    const TemporaryFolder folder;
    const Ended all = Running({"--help"}, folder.path).wait();
    CHECK(all.code == 0);
    CHECK_THAT(all.out, Catch::Contains("\nAt the loom:\n") && !Catch::Contains("\nCommands:\n"));  // each has its people
    for (const char* command :
         {"init",   "serve",    "login",   "logout",          "me",           "user",    "loom",
          "key",    "submit",   "comment", "request-changes", "waive",        "approve", "release",
          "sign",   "withdraw", "pull",    "evidence",        "export",       "log",     "diff",
          "audit",  "verify",   "backup",  "restore",         "verify-files", "save",    "design",
          "policy", "trust",    "signer",  "faults",          "check"}) {
        INFO(command);
        CHECK_THAT(all.out, Catch::Contains(std::string("\n  ") + command + " "));
        const Ended one = Running({command, "--help"}, folder.path).wait();
        CHECK(one.code == 0);
        CHECK_THAT(one.out, Catch::Contains("Exit status"));
    }
}

TEST_CASE("the help has a word for every value and none of the parser's own", "[commands]") {
    const TemporaryFolder folder;
    const auto help_of = [&](std::vector<std::string> words) {
        words.emplace_back("--help");
        return Running(words, folder.path).wait().out;
    };
    for (const char* step : {"submit", "approve", "request-changes", "waive", "release", "sign", "withdraw"})
        CHECK_THAT(help_of({step}), Catch::Contains("-r,--reason WHY REQUIRED"));
    CHECK_THAT(help_of({"save"}), Catch::Contains("--message WHAT REQUIRED") && Catch::Contains("--branch BRANCH "));
    CHECK_THAT(help_of({"waive"}), Catch::Contains("--rule RULE ") && Catch::Contains("--loom LOOM "));
    CHECK_THAT(help_of({"login"}), Catch::Contains("--name NAME "));
    CHECK_THAT(help_of({"user", "join"}), Catch::Contains("--name NAME ") && Catch::Contains("--full-name NAME "));
    CHECK_THAT(help_of({"init"}), Catch::Contains("--site NAME ") && Catch::Contains("--store CONNECTION ") &&
                                      Catch::Contains("--host HOST "));
    CHECK_THAT(help_of({"user", "invite"}), !Catch::Contains("{"));
    CHECK_THAT(help_of({"policy"}), !Catch::Contains("FLOAT") && !Catch::Contains("{"));
}

TEST_CASE("an export has no name of another kind of file", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.done("dora", {"design", "make", "cloth"});
    const Ended ended = mill.as("dora", {"export", "cloth", "1", "-o", mill.at("q.png")});
    CHECK(ended.code == 2);
    CHECK_THAT(ended.err, Catch::Contains("--out: takes a name that ends in .weave, or a folder"));
    CHECK_FALSE(std::filesystem::exists(mill.at("q.png")));
}

TEST_CASE("what is saved and is no design is told for what it is", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.done("dora", {"design", "make", "cloth"});
    REQUIRE(write_file(mill.at("card.png"), std::string("\x89PNG\r\n\x1a\n and more")));
    REQUIRE(write_file(mill.at("cloth.yarns"), "weave-yarns 1\n"));
    REQUIRE(write_file(mill.at("half.weave"), "{\"format\":"));
    const auto refused = [&](const char* file, const char* why) {
        const Ended ended = mill.as("dora", {"save", mill.at(file), "cloth", "--message", "A mistake"});
        INFO(ended.err);
        CHECK(ended.code == 3);
        CHECK_THAT(ended.err, Catch::Contains(std::string(file) + ": " + why) && !Catch::Contains("BOM"));
    };
    refused("card.png", "is no design, which would begin with {");
    refused("cloth.yarns", "holds relaxed yarns, no design");
    refused("half.weave", "is not JSON");
    REQUIRE(write_file(mill.at("large.yarns"), "weave-yarns 1\n" + std::string(std::size_t{33} << 20, '.')));
    refused("large.yarns", "holds relaxed yarns, no design");
    REQUIRE(write_file(mill.at("large.weave"), "{" + std::string(std::size_t{33} << 20, ' ')));
    refused("large.weave", "is larger than the limit");
    const Ended long_winded = mill.as("dora", {"save", mill.at("half.weave"), "cloth", "--message", std::string(4001, 'a')});
    CHECK_THAT(long_winded.err, Catch::Contains("--message: is longer than 4000 bytes"));
    const Ended picture = mill.as("mary", {"loom", "add", "nine", mill.at("card.png")});
    CHECK(picture.code == 3);
    CHECK_THAT(picture.err, Catch::Contains("card.png: is no profile of a loom"));
}

TEST_CASE("a list of nothing says so", "[commands]") {
    CommandMill mill;
    mill.first_joins();
    for (const char* list : {"loom", "signer"}) {
        INFO(list);
        const Ended ended = mill.run({list, "list", "--session", mill.at("mary")});
        CHECK(ended.code == 0);
        CHECK(ended.out == "none\n");
    }
}

TEST_CASE("who was signed out elsewhere is told how to sign in again", "[commands]") {
    CommandMill mill;
    mill.first_joins();
    std::filesystem::copy_file(mill.at("mary"), mill.at("elsewhere"));
    mill.done("elsewhere", {"logout"});
    const Ended ended = mill.as("mary", {"design", "list"});
    CHECK(ended.code == 4);
    CHECK_THAT(ended.err, Catch::Contains("(loomlink login)"));
}

TEST_CASE("who has not signed in, or not rightly, is refused with 4", "[commands]") {
    CommandMill mill;
    mill.first_joins();
    const Ended nobody = mill.as("nobody", {"design", "list"});
    CHECK(nobody.code == 4);
    CHECK_THAT(nobody.err, Catch::Contains("loomlink login"));
    CHECK(nobody.json().at("error").at("kind") == "refused");

    const auto wrong = mill.put_private("wrong", "not the password\n");
    const Ended denied = mill.as("mary", {"login", "--password-file", wrong});
    CHECK(denied.code == 4);
    CHECK(mill.as("mary", {"me"}).code == 0);  // a log-in that fails leaves the session as it is
    CHECK(mill.as("mary", {"trust", "publish", "--password-file", wrong}).code == 4);
    CHECK(mill.as("mary", {"design", "make", "cloth"}).code == 4);

    REQUIRE(::chmod(mill.at("mary").c_str(), 0644) == 0);
    const Ended open_to_all = mill.as("mary", {"me"});
    CHECK(open_to_all.code == 4);
    CHECK_THAT(open_to_all.err, Catch::Contains("0600"));
    REQUIRE(::chmod(mill.at("password").c_str(), 0644) == 0);
    CHECK(mill.as("eve", {"login", mill.url(), "--name", "mary", "--fingerprint", mill.fingerprint()}, true)
              .code == 4);
}

TEST_CASE("a server that is not the one that is meant gets no password", "[commands]") {
    CommandMill mill;
    mill.first_joins();
    const auto log_in = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"login", mill.url(), "--name", "mary"};
        words.insert(words.end(), more.begin(), more.end());
        return mill.as("other", words, true);
    };
    const Ended untrusted = log_in({});
    CHECK(untrusted.code == 4);
    CHECK_THAT(untrusted.err, Catch::Contains("not trusted"));
    CHECK(log_in({"--fingerprint", std::string(64, 'a')}).code == 4);
    const Ended too_short = log_in({"--fingerprint", "4f3a"});
    CHECK(too_short.code == 3);
    CHECK_THAT(too_short.err,
               Catch::Contains("--fingerprint: must be 64") && Catch::Contains("when it starts"));
    CHECK_FALSE(std::filesystem::exists(mill.at("other")));
    std::string colons;
    for (const char c : mill.fingerprint())
        colons += (colons.size() % 3 == 2 ? ":" : "") +
                  std::string(1, c >= 'a' && c <= 'f' ? static_cast<char>(c - 'a' + 'A') : c);
    CHECK(log_in({"--fingerprint", colons}).code == 0);
    CHECK(mode_of(mill.at("other")) == 0600);
    CHECK(mill.as("far", {"login", "http://mill.example:8443", "--name", "mary"}, true).code == 4);
    CHECK(mill.as("far", {"login", "mill:8443", "--name", "mary"}, true).code == 3);
    mill.stop();
    const Ended gone = mill.as("other", {"me"});
    CHECK(gone.code == 5);
    CHECK(gone.json().at("error").at("kind") == "system");
}

TEST_CASE("without a word about it the session lies at home, for its owner alone", "[commands]") {
    CommandMill mill(true);
    const auto link = mill.introduction.at("invitation").get<std::string>();
    const Ended joined = mill.run({"user", "join", link, "--name", "mary", "--full-name", "Mary",
                                   "--password-file", mill.at("password")});
    INFO(joined.err);
    REQUIRE(joined.code == 0);
    CHECK(mode_of(mill.at(".config") / "loomlink" / "session.json") == 0600);
    CHECK(mode_of(mill.at(".config") / "loomlink") == 0700);
    const Ended me = mill.run({"me"});
    CHECK(me.code == 0);
    CHECK_THAT(me.out, Catch::Contains("mary (Mary): admin"));
}

TEST_CASE("files that cannot be understood are bad input, with their name", "[commands]") {
    CommandMill mill;
    mill.set_up();
    mill.done("dora", {"design", "make", "cloth"});
    REQUIRE(write_file(mill.at("bad.weave"), "{}"));
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"save", mill.at("bad.weave"), "cloth", "-m", "x"},
             {"save", mill.at("none.weave"), "cloth", "-m", "x"},
         }) {
        const Ended ended = mill.as("dora", words);
        CHECK(ended.code == 3);
        CHECK_THAT(ended.err, Catch::Contains(std::filesystem::path(words[1]).filename().string()));
    }
    const Ended profile = mill.as("mary", {"loom", "add", "eight", mill.at("bad.weave")});
    CHECK(profile.code == 3);
    CHECK_THAT(profile.err, Catch::Contains("bad.weave"));
    CHECK(mill.as("dora", {"design", "show", "nothing"}).code == 4);
}
