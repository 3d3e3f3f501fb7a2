#include <weave/command/command.hpp>
#include <weave/core/log.hpp>

#include <catch2/catch.hpp>

#include <iostream>
#include <sstream>
#include <vector>

using namespace weave;

namespace {

/// What goes to standard output and standard error while one lives.
class Heard {
  public:
    Heard() : m_out(std::cout.rdbuf(out.rdbuf())), m_err(std::cerr.rdbuf(err.rdbuf())) {}
    ~Heard() {
        std::cout.rdbuf(m_out);
        std::cerr.rdbuf(m_err);
    }
    Heard(const Heard&) = delete;
    Heard& operator=(const Heard&) = delete;
    std::ostringstream out, err;

  private:
    std::streambuf *m_out, *m_err;
};

struct Ended {
    int code = 0;
    std::string out, err;
};

/// A program `loom` with the command `weave`, which does `work`, and the group `beam` with `wind` and `turn`.
Ended run(std::vector<std::string> words, const std::function<Status(CommandOutcome&)>& work,
          JsonLayout layout = JsonLayout::on_one_line) {
    const Heard heard;
    CommandOutcome outcome("loom", layout);
    CLI::App app("Weaves.\n", "loom");
    prepare_program(app, "7.1");
    on_run(add_command(app, outcome, "weave", "Weave a cloth", "loom weave"), outcome,
           [&] { return work(outcome); });
    CLI::App* const beam = app.add_subcommand("beam", "The warp's beams")->require_subcommand(1);
    for (const char* name : {"wind", "turn"}) add_command(*beam, outcome, name, "A beam's command");
    words.insert(words.begin(), "loom");
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    const int code = run_program(app, outcome, static_cast<int>(pointers.size()), pointers.data());
    return {code, heard.out.str(), heard.err.str()};
}

Status nothing(CommandOutcome&) {
    return {};
}

}  // namespace

TEST_CASE("an answer is JSON or words, laid out as the program likes") {
    const auto answers = [](CommandOutcome& outcome) -> Status {
        outcome.answer({{"name", "s\u00fcd"}}, "the south\n");
        return {};
    };
    CHECK(run({"weave"}, answers).out == "the south\n");
    CHECK(run({"weave", "--json"}, answers).out == "{\"name\":\"s\\u00fcd\"}\n");
    CHECK(run({"weave", "--json"}, answers, JsonLayout::over_lines).out ==
          "{\n \"name\": \"s\\u00fcd\"\n}\n");
}

TEST_CASE("an error is told once, by its exit status, in words and to a program") {
    const auto fails = [](CommandOutcome&) -> Status { return invalid("too\nlong", "picks[3]"); };
    const Ended words = run({"weave"}, fails);
    CHECK(words.code == 1);
    CHECK(words.out.empty());
    CHECK(words.err == "loom: picks[3]: too\\x0along\n");
    const Ended json = run({"weave", "--json"}, fails);
    CHECK(
        parse_json(json.out).value() ==
        Json{{"error", {{"kind", "invalid"}, {"where", "picks[3]"}, {"message", "too\nlong"}, {"exit", 1}}}});
    const Ended after = run({"weave", "--json"}, [](CommandOutcome& outcome) -> Status {
        outcome.answer({{"known", 1}}, "");
        return Error{ErrorCode::refused, "no", ""};
    });
    CHECK(after.code == 4);
    CHECK(after.out == "{\"known\":1}\n");
    const auto found = [](CommandOutcome& outcome) -> Status { return outcome.found_something(), Status(); };
    CHECK(run({"weave"}, found).code == 1);
}

TEST_CASE("what is thrown ends as a fault of the system, and what the library tells is heard") {
    const Ended thrown =
        run({"weave", "--json"}, [](CommandOutcome&) -> Status { throw std::runtime_error("torn"); });
    CHECK(thrown.code == 5);
    CHECK(parse_json(thrown.out).value().at("error").at("message") == "torn");
    const Ended told = run({"weave"}, [](CommandOutcome&) -> Status {
        log(LogLevel::debug, "not this");
        return log(LogLevel::warning, "a link kept the old content"), Status();
    });
    CHECK(told.code == 0);
    CHECK(told.err == "loom: a link kept the old content\n");
}

TEST_CASE("a call that makes no sense ends with 2 and says what there is") {
    const auto says = [](const std::vector<std::string>& words, const std::string& help = "'loom --help' or 'loom COMMAND --help'") {
        const Ended ended = run(words, nothing);
        CHECK(ended.code == 2);
        CHECK(ended.out.empty());
        CHECK_THAT(ended.err, Catch::EndsWith("\nTry " + help + ".\n"));
        return ended.err.substr(0, ended.err.find('\n'));
    };
    CHECK(says({}) == "loom: name a command");
    CHECK(says({"spin"}) == "loom: there is no command 'spin'");
    CHECK(says({"--fast"}) == "loom: there is no option '--fast'");
    const std::string of_beam = "'loom beam --help' or 'loom beam COMMAND --help'";
    CHECK(says({"beam"}, of_beam) == "loom: name what to do; beam has wind and turn");
    CHECK(says({"beam", "burn"}, of_beam) == "loom: there is no command 'burn' of beam; beam has wind and turn");
    CHECK(says({"weave", "--fast", "9"}, "'loom weave --help'") == "loom: there is no option '--fast' here");
    CHECK(says({"beam", "wind", "tight"}, "'loom beam wind --help'") == "loom: 'tight' is one word too many");
    const Json error = parse_json(run({"beam", "--json"}, nothing).out).value().at("error");
    CHECK(error.at("kind") == "usage");
    CHECK(error.at("message") == "name what to do; beam has wind and turn");
}

TEST_CASE("help and version are told, with what the exit status means") {
    CHECK(run({"--version"}, nothing).out == "loom 7.1\n");
    const Ended help = run({"weave", "--help"}, nothing);
    CHECK(help.code == 0);
    CHECK_THAT(help.out, Catch::Contains("Example: loom weave\n") && Catch::Contains("Exit status: 0 done"));
    CHECK_THAT(run({"--help"}, nothing).out, Catch::Contains("'loom COMMAND --help'"));
}
