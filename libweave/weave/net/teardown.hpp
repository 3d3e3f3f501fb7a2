#pragma once

#include <weave/net/stream.hpp>

#include <algorithm>
#include <array>
#include <boost/beast/core/role.hpp>
#include <memory>

namespace weave::net {

/// Reads what a client still sends, up to a bound: closed with bytes unread, it would lose the frame that
/// says why.
template <class Handler>
class Drain {
  public:
    Drain(Stream& stream, Handler handler)
        : m_stream(stream),
          m_handler(std::move(handler)),
          m_nowhere(std::make_shared<std::array<char, 4096>>()) {}

    void operator()(error_code error = {}, std::size_t size = 0) {
        m_left -= std::min(size, m_left);
        if (error || m_left == 0) return m_handler(error_code());
        auto& socket = m_stream.socket();
        socket.async_read_some(asio::buffer(*m_nowhere), std::move(*this));
    }

  private:
    Stream& m_stream;
    Handler m_handler;
    std::shared_ptr<std::array<char, 4096>> m_nowhere;
    std::size_t m_left = 1 << 20;
};

/// Beast calls these when a WebSocket has ended; its own timer closes the stream if the other side does not.
inline void beast_close_socket(Stream& stream) {
    stream.close();
}
template <class Handler>
void async_teardown(boost::beast::role_type, Stream& stream, Handler&& handler) {
    error_code ignored;
    stream.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    asio::post(stream.get_executor(), Drain<std::decay_t<Handler>>(stream, std::forward<Handler>(handler)));
}

}  // namespace weave::net
