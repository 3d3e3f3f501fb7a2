#include <weave/net/client.hpp>

#include <weave/core/text.hpp>
#include <weave/net/dial.hpp>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>

namespace weave::net {

namespace {

namespace beast = boost::beast;
namespace http = beast::http;

constexpr std::size_t piece_bytes = 65536;
constexpr Milliseconds between_reports{50};

bool may_be_repeated(const ClientRequest& request) {
    return request.method == "GET" || request.method == "HEAD";
}

Result<std::string> request_head(const ClientRequest& request, const ClientOptions& options) {
    const auto plain = [](std::string_view text) {
        return text.find_first_of(" \t\r\n") == std::string_view::npos;
    };
    if (!is_sendable(request.method, request.target) || !request.target.starts_with('/') ||
        !plain(request.target))
        return Error{ErrorCode::usage, "is no request", on_one_line(request.method + " " + request.target)};
    std::string head =
        request.method + " " + request.target + " HTTP/1.1\r\nHost: " + host_field(options) + "\r\n";
    for (const auto& [name, value] : request.headers) {
        if (!is_sendable(name, value))
            return Error{ErrorCode::usage, "is no header field", on_one_line(name)};
        head += name + ": " + value + "\r\n";
    }
    if (!request.body.empty() || request.method == "POST" || request.method == "PUT" ||
        request.method == "PATCH")
        head += "Content-Length: " + std::to_string(request.body.size()) + "\r\n";
    return head + "\r\n";
}

}  // namespace

/// An open connection of the client, and one request on it at a time.
class HttpClient::Connected {
  public:
    explicit Connected(const ClientOptions& options) : m_options(options) {}

    /// Whether the last request left the connection fit for another.
    [[nodiscard]] bool reusable() const { return m_reusable; }
    /// Whether the server closed the connection before it answered anything.
    [[nodiscard]] bool was_stale() const { return m_stale; }

    Result<Response> send(const std::string& head, const ClientRequest& request, const Sink* sink) {
        Result<Response> outcome = system_fault("the request failed", place_of(m_options));
        const auto run = [&]() -> asio::awaitable<void> { outcome = co_await talk(head, request, sink); };
        m_sent = 0;
        m_io.restart();
        asio::co_spawn(m_io, run, asio::detached);
        if (!request.progress) return m_io.run(), outcome;
        while (!m_io.stopped()) {
            m_io.run_for(between_reports);
            if (!m_io.stopped() && !request.progress(m_sent)) return given_up();
        }
        return outcome;
    }

  private:
    using Parser = http::response_parser<http::buffer_body>;

    /// What still waits goes with this connection, which is of no use any more.
    Error given_up() {
        m_io.stop();
        m_reusable = m_stale = false;
        return {ErrorCode::refused, "the request was given up", place_of(m_options)};
    }

    asio::awaitable<Result<Response>> talk(const std::string& head, const ClientRequest& request,
                                           const Sink* sink) {
        m_reusable = false;
        m_stale = false;
        if (!m_line) {
            auto dialled = co_await dial(m_options);
            if (!dialled) co_return std::move(dialled).error();
            m_line = std::move(*dialled);
        }
        Result<Response> answered = co_await ask(head, request, sink);
        m_line->deadline.clear();
        co_return answered;
    }

    asio::awaitable<Result<Response>> ask(const std::string& head, const ClientRequest& request,
                                          const Sink* sink) {
        co_await write(head);
        co_await write(request.body, &m_sent);  // a server that refuses early answers all the same
        m_line->deadline.set(m_line, m_options.answer_time);
        Parser parser;
        parser.body_limit(boost::none);
        parser.skip(request.method == "HEAD");
        const auto [error, size] =
            co_await http::async_read_header(m_line->stream, m_buffer, parser, as_result);
        if (error) {
            m_stale = !m_line->deadline.passed() && m_buffer.size() == 0 && !parser.got_some();
            co_return failure(error);
        }
        Response response;
        response.status = static_cast<int>(parser.get().result_int());
        for (const auto& field : parser.get())
            response.headers.add(std::string(field.name_string()), std::string(field.value()));
        const Sink* const taker = response.status == 200 ? sink : nullptr;
        Status read = co_await read_body(parser, taker, response);
        if (!read) co_return std::move(read).error();
        m_reusable = parser.keep_alive() && m_buffer.size() == 0;
        co_return response;
    }

    /// Sends all of it, as long as it goes on; that it failed shows when the answer is read.
    asio::awaitable<void> write(std::string_view bytes, std::size_t* sent = nullptr) {
        while (!bytes.empty()) {
            m_line->deadline.set(m_line, m_options.stall_time);
            const auto [error, size] = co_await m_line->stream.async_write_some(
                asio::const_buffer(bytes.data(), std::min(bytes.size(), piece_bytes)), as_result);
            if (error) break;
            bytes.remove_prefix(size);
            if (sent != nullptr) *sent += size;
        }
    }

    asio::awaitable<Status> read_body(Parser& parser, const Sink* sink, Response& response) {
        std::string kept;
        std::vector<char> piece(piece_bytes);
        while (!parser.is_done()) {
            parser.get().body().data = piece.data();
            parser.get().body().size = piece.size();
            m_line->deadline.set(m_line, m_options.stall_time);
            const auto [error, size] =
                co_await http::async_read_some(m_line->stream, m_buffer, parser, as_result);
            if (error && error != http::error::need_buffer) co_return failure(error);
            const std::string_view got(piece.data(), piece.size() - parser.get().body().size);
            if (sink != nullptr) {
                Status taken = got.empty() ? Status() : (*sink)(got);
                if (!taken) co_return taken;
                continue;
            }
            if (got.size() > m_options.most_body_bytes - kept.size())
                co_return bad_input("the answer is too long", place_of(m_options));
            kept += got;
        }
        response.body = make_bytes(std::move(kept));
        co_return Status();
    }

    [[nodiscard]] Error failure(const error_code& error) const {
        const bool nonsense = error.category() == http::make_error_code(http::error::bad_chunk).category() &&
                              error != http::error::end_of_stream && error != http::error::partial_message;
        if (nonsense && !m_line->deadline.passed())
            return bad_input("the server's answer is no HTTP: " + error.message(), place_of(m_options));
        return network_fault(m_options, error, m_line->deadline.passed());
    }

    const ClientOptions m_options;
    asio::io_context m_io{1};
    std::shared_ptr<Dialled> m_line;
    beast::flat_buffer m_buffer{piece_bytes};
    std::size_t m_sent = 0;  ///< of the body
    bool m_reusable = false;
    bool m_stale = false;
};

HttpClient::HttpClient(ClientOptions options) : m_options(std::move(options)) {}
HttpClient::HttpClient(HttpClient&&) noexcept = default;
HttpClient& HttpClient::operator=(HttpClient&&) noexcept = default;
HttpClient::~HttpClient() = default;

Result<Response> HttpClient::send(const ClientRequest& request) {
    return transfer(request, nullptr);
}

Result<Response> HttpClient::send(const ClientRequest& request, const Sink& sink) {
    return transfer(request, &sink);
}

Result<Response> HttpClient::transfer(const ClientRequest& request, const Sink* sink) {
    WEAVE_TRY(const std::string head, request_head(request, m_options));
    const bool kept = m_connected != nullptr;
    if (!kept) m_connected = std::make_unique<Connected>(m_options);
    Result<Response> answered = m_connected->send(head, request, sink);
    if (kept && m_connected->was_stale() && may_be_repeated(request)) {
        m_connected = std::make_unique<Connected>(m_options);
        answered = m_connected->send(head, request, sink);
    }
    if (!m_connected->reusable()) m_connected.reset();
    return answered;
}

Result<ClientOptions> parse_origin(const std::string& origin) {
    const auto wrong = [&] {
        return bad_input("is no http:// or https:// address, nor unix: and a path", on_one_line(origin));
    };
    ClientOptions options;
    std::string_view rest = origin;
    if (rest.starts_with("unix:")) {
        rest.remove_prefix(5);
        if (rest.empty() || rest.ends_with('/') || on_one_line(origin) != origin) return wrong();
        options.unix_socket = rest;
        return options;
    }
    if (rest.starts_with("https://"))
        options.tls.emplace();
    else if (!rest.starts_with("http://"))
        return wrong();
    rest.remove_prefix(rest.find("//") + 2);
    if (rest.ends_with('/')) rest.remove_suffix(1);
    options.port = options.tls ? 443 : 80;
    const std::size_t colon = rest.find_last_of(":]");
    if (colon != std::string_view::npos && rest[colon] == ':') {
        const auto port = parse_whole(rest.substr(colon + 1));
        if (!port || *port < 1 || *port > 65535) return wrong();
        options.port = static_cast<std::uint16_t>(*port);
        rest = rest.substr(0, colon);
    }
    if (rest.starts_with('[') && rest.ends_with(']')) rest = rest.substr(1, rest.size() - 2);
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_:";
    if (rest.empty() || rest.find_first_not_of(letters) != std::string_view::npos) return wrong();
    options.host = std::string(rest);
    return options;
}

}  // namespace weave::net
