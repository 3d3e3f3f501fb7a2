#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <memory>
#include <optional>

namespace weave::net {

namespace asio = boost::asio;
using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Socket = asio::generic::stream_protocol::socket;  ///< of TCP, or a Unix socket
using Endpoint = asio::generic::stream_protocol::endpoint;
using Milliseconds = std::chrono::milliseconds;

/// A coroutine's way to wait: the outcome comes as a tuple, nothing is thrown.
inline constexpr auto as_result = asio::as_tuple(asio::use_awaitable);

/// A connection over TCP, with or without TLS, or over a Unix socket: one type for all, so that what stands
/// on it is compiled once. All calls must come from its executor.
class Stream {
  public:
    using executor_type = asio::any_io_executor;

    explicit Stream(Socket socket) : m_socket(std::move(socket)) {}

    executor_type get_executor() { return m_socket.get_executor(); }
    Socket& socket() { return m_socket; }
    /// From now on what is read and written goes through TLS.
    asio::ssl::stream<Socket&>& add_tls(asio::ssl::context& context) {
        return m_tls.emplace(m_socket, context);
    }
    asio::ssl::stream<Socket&>* tls() { return m_tls ? &*m_tls : nullptr; }

    /// Ends every pending operation.
    void close() {
        error_code ignored;
        m_socket.close(ignored);
    }

    template <class Buffers, class Token>
    auto async_read_some(const Buffers& buffers, Token&& token) {
        return asio::async_initiate<Token, void(error_code, std::size_t)>(
            [this](auto handler, const Buffers& into) {
                if (m_tls)
                    m_tls->async_read_some(into, std::move(handler));
                else
                    m_socket.async_read_some(into, std::move(handler));
            },
            token, buffers);
    }

    template <class Buffers, class Token>
    auto async_write_some(const Buffers& buffers, Token&& token) {
        return asio::async_initiate<Token, void(error_code, std::size_t)>(
            [this](auto handler, const Buffers& from) {
                if (m_tls)
                    m_tls->async_write_some(from, std::move(handler));
                else
                    m_socket.async_write_some(from, std::move(handler));
            },
            token, buffers);
    }

  private:
    Socket m_socket;
    std::optional<asio::ssl::stream<Socket&>> m_tls;
};

/// Closes a stream when a time is over. Lives on the stream's executor; its owner must keep `owner` alive as
/// long as the stream.
class Deadline {
  public:
    explicit Deadline(Stream& stream) : m_stream(stream), m_timer(stream.get_executor()) {}

    /// From now on the stream has this long; `owner` keeps deadline and stream alive meanwhile.
    template <class Owner>
    void set(std::shared_ptr<Owner> owner, Milliseconds time) {
        m_timer.expires_after(time);
        m_timer.async_wait([this, owner = std::move(owner)](error_code) {
            if (m_timer.expiry() > asio::steady_timer::clock_type::now()) return;  // cleared or set anew
            m_passed = true;
            m_stream.close();
        });
    }
    void clear() { m_timer.expires_at(asio::steady_timer::time_point::max()); }
    [[nodiscard]] bool passed() const { return m_passed; }

  private:
    Stream& m_stream;
    asio::steady_timer m_timer;
    bool m_passed = false;
};

}  // namespace weave::net
