#include <simd/link/link.hpp>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <sys/socket.h>
#include <sys/time.h>

namespace weave::simd {

namespace {

Error link_fault(const char* action) {
    return system_fault(std::string("cannot ") + action + " between daemon and worker: " + std::strerror(errno));
}

}  // namespace

Result<std::pair<Descriptor, Descriptor>> Link::pair() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return link_fault("make a socket");
    std::pair<Descriptor, Descriptor> both{Descriptor(ends[0]), Descriptor(ends[1])};
    const timeval patience{link_patience.count(), 0};
    for (const int end : ends) {
        if (::setsockopt(end, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience) != 0) return link_fault("set up a socket");
    }
    return both;
}

Status Link::send(const Json& message) {
    return send('c', canonical_json(message), 0);
}

Status Link::post(const Json& message) {
    return send('c', canonical_json(message), MSG_DONTWAIT);
}

Status Link::send_frame(std::string_view bytes) {
    return send('f', bytes, 0);
}

Status Link::send(char kind, std::string_view bytes, int flags) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::array<char, 5> head{};
    for (std::size_t k = 0; k < 4; ++k) head[k] = static_cast<char>(size >> (8 * k) & 0xffU);
    head[4] = kind;
    const std::lock_guard lock(m_sending);
    for (std::string_view part : {std::string_view(head.data(), head.size()), bytes}) {
        while (!part.empty()) {
            const ssize_t sent = ::send(m_socket.number(), part.data(), part.size(), MSG_NOSIGNAL | flags);
            if (sent < 0 && errno == EINTR) continue;
            if (sent < 0) {
                const Error fault = link_fault("send");
                cut();  // half a message is none
                return fault;
            }
            part.remove_prefix(static_cast<std::size_t>(sent));
        }
    }
    return {};
}

bool Link::read_whole(char* into, std::size_t size) {
    while (size > 0) {
        const ssize_t got = ::recv(m_socket.number(), into, size, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        into += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

Result<std::optional<LinkMessage>> Link::receive() {
    std::array<char, 5> head{};
    if (!read_whole(head.data(), head.size())) return std::optional<LinkMessage>();
    std::size_t size = 0;
    for (std::size_t k = 0; k < 4; ++k) size |= std::size_t(static_cast<unsigned char>(head[k])) << (8 * k);
    if (size > most_link_bytes || (head[4] != 'c' && head[4] != 'f')) return bad_input("the other end of the link sends nonsense");
    LinkMessage message{head[4] == 'f', std::string(size, '\0')};
    if (!read_whole(message.bytes.data(), size)) return std::optional<LinkMessage>();
    return std::optional<LinkMessage>(std::move(message));
}

void Link::stop_receiving() {
    ::shutdown(m_socket.number(), SHUT_RD);
}

void Link::cut() {
    ::shutdown(m_socket.number(), SHUT_RDWR);
}

}  // namespace weave::simd
