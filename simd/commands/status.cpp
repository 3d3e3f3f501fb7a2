// status and top: what a daemon is doing.

#include <weave/command/server_wish.hpp>
#include <weave/command/serving.hpp>
#include <weave/core/text.hpp>
#include <weave/wire/client.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <simd/commands/command.hpp>
#include <simd/commands/running_daemon.hpp>
#include <simd/commands/status_table.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

namespace weave::simd {

namespace {

struct StatusWords {
    std::string folder = ".";
    ServerWish server;
};

/// The daemon of the folder, unless another place was named.
Result<wire::ServerPlace> place_of_words(const StatusWords& words) {
    if (!words.server.host.empty()) return place_of(words.server);
    return wire::place_of("unix:" + std::filesystem::absolute(DaemonFolder{words.folder}.socket()).string());
}

Result<Json> status_from(const wire::ServerPlace& place) {
    constexpr std::uint64_t most = std::uint64_t{16} << 20;
    WEAVE_TRY(const std::string text, wire::download(place, "/api/v1/status", most));
    return parse_json(text);
}

/// Columns and lines of the terminal.
std::pair<std::size_t, std::size_t> size_of_terminal() {
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return {120, 40};
    return {size.ws_col, size.ws_row};
}

Status status(const StatusWords& words, CommandOutcome& outcome) {
    WEAVE_TRY(const wire::ServerPlace place, place_of_words(words));
    WEAVE_TRY(const Json status, status_from(place));
    outcome.answer(status, status_table(status, 200, std::numeric_limits<std::size_t>::max()));
    return {};
}

/// The terminal's other screen, which leaves what was there before as it was.
class OtherScreen {
  public:
    OtherScreen() { std::cout << "\033[?1049h\033[?25l"; }
    ~OtherScreen() { std::cout << "\033[?25h\033[?1049l" << std::flush; }
    OtherScreen(const OtherScreen&) = delete;
    OtherScreen& operator=(const OtherScreen&) = delete;
};

Status top(const StatusWords& words, CommandOutcome& outcome) {
    if (::isatty(STDOUT_FILENO) == 0) return status(words, outcome);
    WEAVE_TRY(const wire::ServerPlace place, place_of_words(words));
    WEAVE_TRY(Json seen, status_from(place));
    const EndingSignals signals;
    const OtherScreen screen;
    std::string trouble;
    while (true) {
        const auto [columns, lines] = size_of_terminal();
        const std::size_t room = std::max<std::size_t>(lines, 2) - 1;
        std::cout << "\033[H\033[J" << status_table(seen, columns, trouble.empty() ? room : room - 1) << clipped(trouble, columns) << std::flush;
        if (signals.wait(std::chrono::seconds(1))) return {};
        auto next = status_from(place);
        trouble = next ? "" : "trying again: " + on_one_line(next.error().text());
        if (next) seen = std::move(*next);
    }
}

CLI::App* add_status_command(CLI::App& app, CommandOutcome& outcome, const char* name, const char* help, const std::shared_ptr<StatusWords>& words) {
    CLI::App* const command = add_command(app, outcome, name, help);
    command->add_option("FOLDER", words->folder, "the folder of a daemon of this machine; the current one if not given");
    add_server_options(command, words->server);
    return command;
}

}  // namespace

void add_status_commands(CLI::App& app, CommandOutcome& outcome) {
    const auto words = std::make_shared<StatusWords>();
    on_run(add_status_command(app, outcome, "status", "Tell what a daemon is doing", words), outcome, [words, &outcome] { return status(*words, outcome); });
    on_run(add_status_command(app, outcome, "top", "Show on a terminal what a daemon is doing, every second, until Ctrl-C; elsewhere once", words), outcome,
           [words, &outcome] { return top(*words, outcome); });
}

}  // namespace weave::simd
