#include "loomlink_site.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace weave::bench {

namespace {

std::string beside_this_program(const char* name) {
    return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name).string();
}

std::string text_of(const net::Response& response) {
    return response.body ? *response.body : "";
}

std::string next_request() {
    static std::atomic<int> count{0};
    return "bench-request-" + std::to_string(++count);
}

}  // namespace

Result<net::Response> LoomlinkSite::Person::ask(const std::string& method, const std::string& path,
                                                Json body) {
    net::ClientRequest request{method, "/api/v1" + path, {}, {}};
    if (!m_token.empty()) request.headers.set("Authorization", "Bearer " + m_token);
    if (method != "GET") {
        if (!body.contains("request")) body["request"] = next_request();
        request.headers.set("Content-Type", "application/json");
        request.body = body.dump();
    }
    return m_client.send(request);
}

Json LoomlinkSite::Person::done(const std::string& method, const std::string& path, const Json& body) {
    Json wish = body;
    if (method != "GET" && !wish.contains("request")) wish["request"] = next_request();
    auto answer = ask(method, path, wish);
    // The service closes connections that nobody used for a while; the same request again does nothing twice.
    if (!answer) answer = ask(method, path, wish);
    if (!answer) throw std::runtime_error(path + ": " + answer.error().text());
    if (answer->status != 200)
        throw std::runtime_error(path + ": " + std::to_string(answer->status) + " " + text_of(*answer));
    return parse_json(text_of(*answer)).value();
}

LoomlinkSite::LoomlinkSite() {
    std::string name = (std::filesystem::temp_directory_path() / "weave-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for the site");
    m_folder = name;
    const auto link = spawn().at("invitation").get<std::string>();
    m_tokens.emplace_back("admin", accept(link.substr(link.find('#') + 1), "admin"));
    m_people.push_back(again("admin"));
    Json policy = administrator().done("GET", "/policy");
    policy["simulation"] = "optional";
    administrator().done("PUT", "/policy", policy);
}

LoomlinkSite::~LoomlinkSite() {
    if (m_process > 0) ::kill(m_process, SIGKILL), ::waitpid(m_process, nullptr, 0);
    if (m_answer >= 0) ::close(m_answer);
    std::error_code ignored;
    std::filesystem::remove_all(m_folder, ignored);
}

Json LoomlinkSite::spawn() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, (m_folder / "told.txt").c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0600);
    std::vector<std::string> words{beside_this_program("loomlink"),
                                   "serve",
                                   (m_folder / "site").string(),
                                   "--port",
                                   "0",
                                   "--host",
                                   "127.0.0.1",
                                   "--json"};
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const int code =
        ::posix_spawn(&m_process, pointers.front(), &actions, nullptr, pointers.data(), ::environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    m_answer = ends[0];
    if (code != 0) throw std::runtime_error("cannot start " + words.front());
    std::string line;
    for (char c = 0; ::read(m_answer, &c, 1) == 1 && c != '\n';) line += c;
    const auto told = parse_json(line);
    if (!told || !told->contains("url")) throw std::runtime_error("loomlink does not serve: " + line);
    m_options = net::parse_origin(told->at("url").get<std::string>()).value();
    m_options.answer_time = std::chrono::minutes(5);  // a busy machine is measured, not given up
    m_options.tls = net::Trust{{}, told->at("certificate_sha256").get<std::string>()};
    return *told;
}

void LoomlinkSite::start() {
    spawn();
    m_people.clear();
    m_people.push_back(again("admin"));
}

std::uintmax_t LoomlinkSite::stop_and_measure() {
    ::kill(m_process, SIGTERM);
    int status = 0;
    ::waitpid(m_process, &status, 0);
    m_process = 0;
    ::close(m_answer);
    m_answer = -1;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error("loomlink did not end in good order");
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(m_folder / "site"))
        if (entry.path().filename().string().starts_with("loomlink.db")) bytes += entry.file_size();
    return bytes;
}

std::string LoomlinkSite::accept(const std::string& code, const std::string& name) const {
    Person nobody(m_options, "");
    const Json body{{"code", code}, {"name", name}, {"full_name", "The " + name}, {"password", password}};
    while (true) {
        const auto answer = nobody.ask("POST", "/invitations/accept", body);
        if (!answer) throw std::runtime_error(name + " cannot join: " + answer.error().text());
        if (answer->status == 200) return parse_json(text_of(*answer)).value().at("token").get<std::string>();
        if (answer->status != 429) throw std::runtime_error(name + " cannot join: " + text_of(*answer));
        std::this_thread::sleep_for(std::chrono::seconds(1));
    }
}

LoomlinkSite::Person LoomlinkSite::join(const std::string& name, const std::string& role) {
    const Json invitation = administrator().done("POST", "/invitations", {{"roles", Json::array({role})}});
    m_tokens.emplace_back(name, accept(invitation.at("code").get<std::string>(), name));
    return again(name);
}

LoomlinkSite::Person LoomlinkSite::again(const std::string& name) const {
    for (const auto& [who, token] : m_tokens)
        if (who == name) return Person(m_options, token);
    throw std::runtime_error("nobody is called " + name);
}

}  // namespace weave::bench
