#include <weave/ranks/comm.hpp>

#include <string>
#include <utility>

namespace weave::ranks {

std::vector<double> Comm::gather(double own) {
    Packet all;
    gather(std::span(&own, 1), std::vector<std::size_t>(size(), 1), all);
    return all;
}

std::vector<Comm::Packet> Comm::gather(const Packet& own) {
    std::vector<std::size_t> counts;
    for (const double count : gather(static_cast<double>(own.size()))) counts.push_back(static_cast<std::size_t>(count));
    Packet all;
    gather(own, counts, all);
    std::vector<Packet> packets;
    auto at = all.begin();
    for (const std::size_t count : counts) {
        const auto end = at + static_cast<std::ptrdiff_t>(count);
        packets.emplace_back(at, end);
        at = end;
    }
    return packets;
}

std::vector<Comm::Packet> Comm::swap(std::vector<Packet> to_each) {
    Packet sizes;
    for (const Packet& packet : to_each) sizes.push_back(static_cast<double>(packet.size()));
    const std::vector<Packet> sizes_of = gather(sizes);
    std::vector<Packet> from_each(size());
    std::vector<Letter> out, in;
    for (std::size_t other = 0; other < size(); ++other) {
        if (other == rank()) {
            from_each[other] = std::move(to_each[other]);
            continue;
        }
        if (!to_each[other].empty()) out.push_back({other, std::move(to_each[other])});
        const auto size = static_cast<std::size_t>(sizes_of[other][rank()]);
        if (size > 0) in.push_back({other, Packet(size)});
    }
    exchange(out, in);
    for (Letter& letter : in) from_each[letter.rank] = std::move(letter.numbers);
    return from_each;
}

Status agreed(Comm& comm, const Status& own) {
    Comm::Packet told;
    if (!own) {
        const Error& error = own.error();
        told.push_back(static_cast<double>(error.code));
        told.push_back(static_cast<double>(error.message.size()));
        for (const char letter : error.message + error.where) told.push_back(static_cast<double>(static_cast<unsigned char>(letter)));
    }
    const std::vector<Comm::Packet> all = comm.gather(told);
    for (std::size_t rank = 0; rank < all.size(); ++rank) {
        if (all[rank].empty()) continue;
        std::string text;
        for (std::size_t k = 2; k < all[rank].size(); ++k) text += static_cast<char>(static_cast<unsigned char>(all[rank][k]));
        const auto length = static_cast<std::size_t>(all[rank][1]);
        const std::string where = text.substr(length);
        const std::string who = rank == 0 ? "" : "rank " + std::to_string(rank);
        return Error{static_cast<ErrorCode>(static_cast<int>(all[rank][0])), text.substr(0, length), who.empty() || where.empty() ? who + where : who + ": " + where};
    }
    return {};
}

}  // namespace weave::ranks
