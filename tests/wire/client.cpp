// One connection to simd: agreeing, asking, and what a client says of a server that does not keep to the protocol.

#include <weave/wire/client.hpp>

#include <catch2/catch.hpp>

#include <support/scripted_simd.hpp>

using namespace weave;
using namespace weave::wire;
using namespace std::chrono_literals;
using Catch::Contains;
using weave::testing::Mishap;
using weave::testing::ScriptedSimd;

namespace {

/// Short where nothing comes, so that no test waits long; long where something does, however slow the machine.
std::chrono::milliseconds patience_for(const Mishap& mishap) {
    const bool silent = !mishap.close && mishap.text.empty() && mishap.binary.empty();
    return silent ? 300ms : 60s;
}

Client connected(const ScriptedSimd& simd) {
    auto client = Client::connect(simd.place(), "test");
    REQUIRE((client ? "" : client.error().text()) == "");
    return std::move(*client);
}

/// The error of a connection on which this happens in place of the welcome.
Error greeted_with(const Mishap& mishap) {
    ScriptedSimd simd;
    simd.script()->mishaps[0] = mishap;
    ServerPlace place = simd.place();
    place.options.answer_time = patience_for(mishap);
    const auto client = Client::connect(place, "test");
    REQUIRE_FALSE(client);
    return client.error();
}

/// The error of a question on which this happens in place of its answer.
Error answered_with(const Mishap& mishap) {
    ScriptedSimd simd;
    simd.script()->mishaps[1] = mishap;
    Client client = connected(simd);
    const auto answer = client.ask(ListJobs{new_request_id()}, patience_for(mishap));
    REQUIRE_FALSE(answer);
    CHECK_THAT(answer.error().text(), Contains("127.0.0.1:"));
    return answer.error();
}

Mishap closed_with(std::uint16_t code) {
    return {code, "", ""};
}

}  // namespace

TEST_CASE("a place is named as people write it") {
    const auto place = [](const std::string& text) { return place_of(text).value(); };
    CHECK((place("box").options.host == "box" && place("box").options.port == 8444 && place("box").options.tls));
    CHECK((place("box:9000").options.port == 9000 && place("box:9000").name == "box:9000"));
    CHECK((place("https://box:8444/").options.tls && place("https://box:8444").options.port == 8444));
    CHECK(place("https://box").options.port == 443);
    CHECK((!place("http://127.0.0.1:9000").options.tls && place("http://localhost:9000").options.port == 9000));
    CHECK((place("[::1]").options.host == "::1" && place("[::1]").options.port == 8444 && place("[::1]:9000").name == "[::1]:9000"));
    CHECK(place("http://[::1]:9000").options.host == "::1");
    CHECK(place("unix:/run/simd/simd.sock").options.unix_socket == "/run/simd/simd.sock");
    CHECK(place("unix:box/simd.sock").options.unix_socket == "box/simd.sock");
    for (const char* wrong : {"", "unix:", "unix:/", "unix:box/", "unix:a\nb", "box:", "box:0", "box:70000", "ftp://box", "two words", "box/path", "dora@box"}) {
        INFO(wrong);
        CHECK_FALSE(place_of(wrong));
    }
    CHECK_THAT(place_of("http://box:9000").error().text(), Contains("within this machine"));
    CHECK_THAT(place_of("http://127.evil.example:1").error().text(), Contains("within this machine"));
}

TEST_CASE("a token is taken as a file holds it, and no error repeats it") {
    ServerPlace place = place_of("box").value();
    REQUIRE(use_token(place, " abc.DEF-_~+/= \r\n"));
    CHECK(place.token == "abc.DEF-_~+/=");
    for (const std::string& wrong : {std::string(" \n"), std::string("se cret"), std::string("secret\nX: y"), std::string(4097, 's'), std::string("s\xc3\xa9")}) {
        const Status status = use_token(place, wrong);
        REQUIRE_FALSE(status);
        CHECK(status.error().text().find("secret") == std::string::npos);
        CHECK(place.token == "abc.DEF-_~+/=");
    }
}

TEST_CASE("a client says hello with its token, asks, and is told what else comes") {
    ScriptedSimd simd;
    simd.script()->token = "right";
    simd.script()->work = [](const Submit&) { return weave::testing::JobResult{{}, {{"converged", true}}, "yarns", {}}; };
    Client client = connected(simd);
    CHECK(client.welcome().person == "dora");
    const auto accepted = answer_of<Accepted>(client.ask(Submit{new_request_id(), "{}", {}, {}}, 20s));
    REQUIRE(accepted);
    REQUIRE(accepted->job == 1U);
    const auto jobs = answer_of<JobList>(client.ask(ListJobs{new_request_id()}, 20s));
    REQUIRE(jobs.value().jobs.size() == 1);
    const auto progress = client.receive(20s), ended = client.receive(20s);  // kept while the list was waited for
    CHECK(std::holds_alternative<JobProgress>(std::get<ServerMessage>(**progress)));
    CHECK(std::get<JobEnded>(std::get<ServerMessage>(**ended)).report.at("converged") == true);
    CHECK_FALSE(client.receive(10ms).value());
    CHECK(download(simd.place(), job_yarns(1), 100).value() == "yarns");
    CHECK_THAT(download(simd.place(), job_yarns(1), 4).error().text(), Contains("more than 4 bytes"));
    const Error missing = download(simd.place(), job_evidence(1), 100).error();
    CHECK((missing.code == ErrorCode::refused && missing.message == "the server answers 404: there is no such file"));
    client.close();
}

TEST_CASE("who has no valid token is told so, and the token is not") {
    ScriptedSimd simd;
    simd.script()->token = "right";
    ServerPlace place = simd.place();
    place.token = "secret-but-wrong";
    const auto client = Client::connect(place, "test");
    REQUIRE_FALSE(client);
    CHECK(client.error().code == ErrorCode::refused);
    CHECK_THAT(client.error().text(), Contains("401: no valid token") && !Contains("secret"));
    const auto file = download(place, job_yarns(1), 100);
    CHECK((file.error().code == ErrorCode::refused && file.error().text().find("secret") == std::string::npos));
}

TEST_CASE("ids of requests are fit to be sent and all different") {
    std::set<std::string> ids;
    for (int k = 0; k < 1000; ++k) ids.insert(new_request_id());
    CHECK(ids.size() == 1000);
    for (const std::string& id : ids) CHECK(read_client_message(write_message(ClientMessage(ListJobs{id}))));
}

TEST_CASE("what the server would refuse unread is not sent") {
    ScriptedSimd simd;
    Client client = connected(simd);
    Submit submit{new_request_id(), "{}", {}, {}};
    submit.simulation.residual = 2;
    const Status sent = client.send(submit);
    REQUIRE_FALSE(sent);
    CHECK((sent.error().code == ErrorCode::usage && sent.error().where == "simulation.residual"));
    submit.simulation.residual.reset();
    submit.document = std::string(most_client_bytes, ' ');
    CHECK_THAT(client.send(submit).error().text(), Contains("is longer than"));
    CHECK(client.ask(AcknowledgeJob{1}, 1s).error().code == ErrorCode::usage);
    CHECK(client.ask(ListJobs{new_request_id()}, 20s));
    CHECK(simd.look([](ScriptedSimd& s) { return s.heard.size(); }) == 2);
}

TEST_CASE("a server that does not greet as the protocol says is none") {
    CHECK_THAT(greeted_with({}).text(), Contains("does not answer in time"));
    CHECK_THAT(greeted_with({{}, "nonsense", ""}).text(), Contains("cannot be read: message"));
    CHECK_THAT(greeted_with({{}, "", "nonsense"}).text(), Contains("cannot be read"));
    CHECK_THAT(greeted_with({{}, R"({"type":"unsupported","versions":[2]})", ""}).text(), Contains("other versions"));
    CHECK_THAT(greeted_with({{}, R"({"type":"welcome","version":2,"server":"x"})", ""}).text(), Contains("was not offered"));
    CHECK_THAT(greeted_with({{}, R"({"type":"gap","session":1,"first":1,"last":1})", ""}).text(), Contains("does not begin"));
    const Error refused = greeted_with({{}, R"({"type":"refused","error":{"kind":"refused","where":"","message":"not today"}})", ""});
    CHECK((refused.code == ErrorCode::refused && refused.message == "not today"));
    CHECK(greeted_with(closed_with(1002)).code == ErrorCode::bad_input);
}

TEST_CASE("what cannot be read is an error of its own kind, whoever sends it") {
    CHECK_THAT(answered_with({{}, R"({"type":"dance"})", ""}).text(), Contains("type: must be one of"));
    CHECK_THAT(answered_with({{}, "{\"type\":\"\\u001b[31m\"}", ""}).text(), !Contains("\x1b"));
    CHECK_THAT(answered_with({{}, "\xff\xfe", ""}).text(), Contains("no UTF-8"));
    CHECK_THAT(answered_with({{}, "", std::string(80, '\0')}).text(), Contains("cannot be read"));
    CHECK_THAT(answered_with({{}, std::string(most_server_bytes + 1, ' '), ""}).text(), Contains("is longer than"));
    const Error huge = answered_with({{}, "", std::string(most_frame_bytes + 1, 'x')});
    CHECK((huge.code == ErrorCode::bad_input && huge.message == "the connection ended over a message that is too long"));
    CHECK_THAT(answered_with({}).text(), Contains("does not answer in time"));
}

TEST_CASE("each way in which a server ends a connection has its words, and tells whether another may go better") {
    const std::map<std::uint16_t, ErrorCode> meanings{
        {1000, ErrorCode::system},    {1001, ErrorCode::system},    {1002, ErrorCode::bad_input}, {1003, ErrorCode::bad_input},
        {1007, ErrorCode::bad_input}, {1008, ErrorCode::refused},   {1009, ErrorCode::bad_input}, {1011, ErrorCode::system},
        {1013, ErrorCode::system},    {4321, ErrorCode::system}};
    std::set<std::string> words;
    for (const auto& [code, meaning] : meanings) {
        INFO(code);
        const Error error = answered_with(closed_with(code));
        CHECK(error.code == meaning);
        words.insert(error.message);
    }
    CHECK(words.size() == meanings.size());
}

TEST_CASE("where nobody listens, the client says so") {
    ServerPlace place;
    {
        ScriptedSimd simd;
        place = simd.place();
    }
    CHECK(Client::connect(place, "test").error().code == ErrorCode::system);
    CHECK(download(place, job_yarns(1), 100).error().code == ErrorCode::system);
}
