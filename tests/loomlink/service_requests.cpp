#include "service_case.hpp"

#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

const net::Headers json_type{{"Content-Type", "application/json"}};
const std::string login = R"({"request":"12345678","name":"anna","password":"x"})";

struct Requests {
    StubService service;
    std::optional<net::HttpClient> client;
    explicit Requests(const net::ThrottleRate& strangers = {1e9, 1e9, 10000}) : service(strangers) {
        service.sessions["designer"] = {{1, "anna", "Anna", {PersonRole::designer}}, "csrf", ""};
        service.sessions["admin"] = {{2, "mary", "Mary", {PersonRole::administrator}}, "csrf", ""};
        service.start();
        client.emplace(service.client_options());
    }
    net::Response post(const std::string& path, const std::string& body, const std::string& token = {},
                       net::Headers headers = json_type) {
        if (!token.empty()) headers.set("Authorization", "Bearer " + token);
        return ask(*client, "POST", "/api/v1" + path, headers, body);
    }
    net::Response get(const std::string& target, const std::string& token = {}) {
        net::Headers headers;
        if (!token.empty()) headers.set("Authorization", "Bearer " + token);
        return ask(*client, "GET", target, headers);
    }
};

}  // namespace

TEST_CASE("a body that is not what the table asks for reaches no handler and is told where") {
    Requests requests;
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "the text ends"},
        {"{", ""},
        {"[]", "must be a JSON object"},
        {"null", "must be a JSON object"},
        {R"({"request":"12345678","name":"anna"})", "password"},
        {R"({"request":"1234567","name":"anna","password":"x"})", "request"},
        {R"({"name":"anna","password":"x"})", "request"},
        {R"({"request":"12345678","name":7,"password":"x"})", "name"},
        {R"({"request":"12345678","name":["anna"],"password":"x"})", "name"},
        {R"({"request":"12345678","name":"","password":"x"})", "name"},
        {R"({"request":"12345678","name":null,"password":"x"})", "name"},
        {R"({"request":"12345678","name":"anna","password":"x","admin":true})", "admin"},
        {R"({"request":"12345678","name":"anna","name":"ben","password":"x"})", ""},
        {R"({"request":"12345678","name":")" + std::string(65, 'a') + R"(","password":"x"})", "name"},
        {"{\"request\":\"12345678\",\"name\":\"\xff\",\"password\":\"x\"}", ""},
        {std::string(2000, '['), ""},
    };
    for (const auto& [body, words] : cases) {
        INFO(body);
        const auto answer = requests.post("/login", body);
        CHECK(answer.status == 400);
        const Json error = json_of(answer).at("error");
        CHECK(error.at("kind") == "bad input");
        if (words != "the text ends")
            CHECK_THAT(error.at("where").get<std::string>() + ": " + error.at("message").get<std::string>(),
                       Catch::Contains(words));
    }
    CHECK(requests.post("/login", std::string(20000, ' ') + login).status == 413);
    CHECK(requests.post("/login", login, {}, {{"Content-Type", "text/plain"}}).status == 415);
    CHECK(requests.post("/login", login, {}, {}).status == 415);
    CHECK(requests.service.reached == 0);
    CHECK(requests.post("/login", login, {}, {{"Content-Type", "Application/JSON; charset=utf-8"}}).status ==
          200);
    CHECK(requests.post("/login", login).status == 200);
}

TEST_CASE("no message repeats a password") {
    Requests requests;
    const std::string secret = "correct horse battery";
    for (const std::string& body :
         {R"({"request":"12345678","name":"anna","password":[")" + secret + "\"]}",
          R"({"request":"12345678","name":"anna","password":")" + secret + std::string(1100, 'x') + "\"}",
          R"({"request":"12345678","name":"anna","password":")" + secret + "\\q\"}"})
        CHECK(requests.post("/login", body).body->find("horse") == std::string::npos);
}

TEST_CASE("numbers and lists are held to their bounds") {
    Requests requests;
    const auto policy = [&](const std::string& members) {
        net::Headers headers = json_type;
        headers.set("Authorization", "Bearer admin");
        return ask(*requests.client, "PUT", "/api/v1/policy", headers,
                   R"({"request":"12345678","simulation":"required","fidelity":"standard","index_valid_hours":24,)" +
                       members + "}")
            .status;
    };
    CHECK(policy(R"("approvals":1,"release_signatures":1,"coverage":0.5)") == 200);
    CHECK(policy(R"("approvals":16,"release_signatures":1,"coverage":0)") == 200);
    for (const char* members : {R"("approvals":0,"release_signatures":1,"coverage":0.5)",
                                R"("approvals":17,"release_signatures":1,"coverage":0)",
                                R"("approvals":1.5,"release_signatures":1,"coverage":0)",
                                R"("approvals":"1","release_signatures":1,"coverage":0)",
                                R"("approvals":1,"release_signatures":18446744073709551615,"coverage":0)",
                                R"("approvals":1,"release_signatures":1e300,"coverage":0)",
                                R"("approvals":1,"release_signatures":1,"coverage":1.01)",
                                R"("approvals":1,"release_signatures":1,"coverage":true)"}) {
        INFO(members);
        CHECK(policy(members) == 400);
    }
    CHECK(requests.post("/invitations", R"({"request":"12345678","roles":["designer","admin"]})", "admin")
              .status == 200);
    for (const char* list : {R"("designer")", R"(["king"])", R"([1])", R"([["designer"]])",
                             R"(["designer","designer","designer","designer","designer","designer"])"})
        CHECK(
            requests
                .post("/invitations", R"({"request":"12345678","roles":)" + std::string(list) + "}", "admin")
                .status == 400);
}

TEST_CASE("a query that is not what the table asks for is refused") {
    Requests requests;
    const std::string card = "/api/v1/designs/shoe/revisions/1/card";
    CHECK(requests.get(card + "?x=0&y=0&w=1&h=1", "designer").status == 200);
    CHECK(requests.get(card + "?x=0&y=0&w=1&h=1&scale=4", "designer").status == 200);
    for (const char* query :
         {"", "?x=0&y=0&w=1", "?x=0&y=0&w=0&h=1", "?x=-1&y=0&w=1&h=1", "?x=0&y=0&w=1&h=1&z=1",
          "?x=0&x=0&y=0&w=1&h=1", "?x=a&y=0&w=1&h=1", "?x=0.5&y=0&w=1&h=1",
          "?x=99999999999999999999&y=0&w=1&h=1", "?x=&y=0&w=1&h=1"}) {
        INFO(query);
        CHECK(requests.get(card + query, "designer").status == 400);
    }
    CHECK(requests.get("/api/v1/designs/shoe/revisions/1/picture?view=../../etc/passwd", "designer").status ==
          400);
}

TEST_CASE("bytes turned at random never hurt the service") {
    Requests requests;
    weave::testing::for_all(
        [&](weave::testing::Random& random) {
            std::string body = login;
            for (std::size_t k = random.between(1, 6); k > 0; --k)
                body[random.between(0, body.size() - 1)] = static_cast<char>(random.between(0, 255));
            if (random.coin()) body.resize(random.between(0, body.size()));
            const int status = requests.post("/login", body).status;
            CHECK((status == 200 || status == 400));
        },
        500);
}

TEST_CASE("one address cannot try without end where no sign-in is needed") {
    Requests requests({3, 0.001, 100});
    for (int k = 0; k < 3; ++k) CHECK(requests.post("/login", login).status == 200);
    const auto answer =
        requests.post("/invitations/accept",
                      R"({"request":"12345678","code":"x","name":"a","full_name":"A","password":"x"})");
    CHECK(answer.status == 429);
    CHECK(std::stoi(std::string(answer.headers.get("Retry-After"))) > 0);
    CHECK(requests.get("/api/v1/openapi.json").status == 200);
    CHECK(requests.get("/api/v1/designs", "designer").status == 200);
}

TEST_CASE("a page of another server makes nobody do anything") {
    Requests requests;
    for (const net::Headers& foreign :
         {net::Headers{{"Sec-Fetch-Site", "cross-site"}}, net::Headers{{"Sec-Fetch-Site", "same-site"}},
          net::Headers{{"Origin", "https://elsewhere.example"}}, net::Headers{{"Origin", "null"}}}) {
        net::Headers headers = foreign;
        headers.set("Content-Type", "application/json");
        CHECK(requests.post("/login", login, {}, headers).status == 403);
        headers.set("Cookie", "loomlink=designer");
        headers.set("X-CSRF-Token", "csrf");
        CHECK(requests.post("/designs", R"({"request":"12345678","name":"shoe"})", {}, headers).status ==
              403);
    }
    CHECK(requests.service.reached == 0);
}

TEST_CASE("what is not in the API document is not served") {
    Requests requests;
    const Json document = json_of(requests.get("/api/v1/openapi.json"));
    for (const auto& [path, methods] : document.at("paths").items()) {
        for (const char* method : {"GET", "POST", "PUT", "PATCH", "DELETE"}) {
            std::string name = method;
            for (char& c : name) c = static_cast<char>(c - 'A' + 'a');
            if (methods.contains(name)) continue;
            INFO(method << " " << path);
            const int status = ask(*requests.client, method, "/api/v1" + filled(path),
                                   {{"Authorization", "Bearer designer"}})
                                   .status;
            CHECK((status == 404 || status == 405));
        }
        for (const char* more : {"/more", "x"}) {
            const auto answer = requests.get("/api/v1" + filled(path) + more, "designer");
            INFO(path << more);
            // One segment more or other may be another line of the table; it must not be a page.
            CHECK(answer.headers.get("Content-Type") == "application/json");
        }
    }
    CHECK(requests.get("/api").status == 404);
    CHECK(requests.get("/api/v2/me").status == 404);
}

TEST_CASE("answers of the API are not kept by browsers or what stands between") {
    Requests requests;
    CHECK(requests.get("/api/v1/designs", "designer").headers.get("Cache-Control") == "no-store");
    CHECK(requests.get("/api/v1/designs").headers.get("Cache-Control") == "no-store");
    CHECK(requests.get("/api/v1/designs").headers.get("WWW-Authenticate") == "Bearer");
}

TEST_CASE("requests are counted under the names of their routes") {
    Requests requests;
    requests.get("/api/v1/designs/secret-name", "designer");
    const auto answer = requests.get("/metrics");
    CHECK(answer.status == 200);
    CHECK_THAT(*answer.body, Catch::Contains("route=\"design\""));
    // They are open to whoever reaches the port, so they name nobody and nothing of the mill.
    for (const char* name : {"secret-name", "anna", "Anna", "127.0.0.1", "localhost"})
        CHECK_THAT(*answer.body, !Catch::Contains(name));
    CHECK(json_of(requests.get("/healthz")) == Json{{"healthy", true}, {"checks", {{"store", true}}}});
}
