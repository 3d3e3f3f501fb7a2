#pragma once

// A decoder of controller files for these tests alone. It shares nothing with the writers: numbers by
// multiplication, bits as texts of 0 and 1, hooks by lists. What is not as the observed files are, it throws
// at.

#include <algorithm>
#include <loomlink/export/read_back.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace weave::testing {

class FileText {
  public:
    explicit FileText(std::string_view bytes) : m_rest(bytes) {}
    [[nodiscard]] bool empty() const { return m_rest.empty(); }
    [[nodiscard]] std::size_t size() const { return m_rest.size(); }
    std::string take(std::size_t count) {
        if (count > m_rest.size()) throw std::runtime_error("the file ends early");
        const std::string taken(m_rest.substr(0, count));
        m_rest.remove_prefix(count);
        return taken;
    }
    void must(const std::string& bytes) {
        if (take(bytes.size()) != bytes) throw std::runtime_error("other bytes than observed");
    }
    std::size_t big(std::size_t count) { return number(take(count)); }
    std::size_t little(std::size_t count) {
        std::string bytes = take(count);
        std::reverse(bytes.begin(), bytes.end());
        return number(bytes);
    }
    std::string until_nul() {
        std::string text;
        while (true) {
            const std::string c = take(1);
            if (c[0] == 0) return text;
            text += c;
        }
    }

  private:
    static std::size_t number(const std::string& bytes) {
        std::size_t value = 0;
        for (const char byte : bytes) value = value * 256 + static_cast<unsigned char>(byte);
        return value;
    }
    std::string_view m_rest;
};

struct DecodedHead {
    loomlink::InFileNames names;
    std::size_t picks = 0, hooks = 0, function_bytes = 0;
    std::vector<std::size_t> areas;
};

inline std::string without_nul(const std::string& field) {
    return field.substr(0, field.find('\0'));
}

inline DecodedHead jc5_head(FileText& file) {
    DecodedHead head;
    file.must("\x81\xFE\x01\x01");
    for (std::size_t left = file.big(4); left > 0; --left) {
        const std::size_t tag = file.big(4), size = file.big(4);
        const std::string value = file.take(size);
        FileText text(value);
        if (tag == 1 && size == 9) head.names.name = without_nul(value);
        if (tag == 2 && size == 4) head.picks = text.big(4);
        if (tag == 6) text.must(std::string(4, '\0'));
        if (tag == 8 && value.find('\0') != size - 1) throw std::runtime_error("the comment has no end");
        if (tag == 8) head.names.comment = without_nul(value);
    }
    for (std::size_t left = file.big(4); left > 0; --left) {
        if (file.big(4) != 100) throw std::runtime_error("no area");
        const std::string value = file.take(file.big(4));
        FileText text(value);
        text.must(std::string("\0\0\0\1", 4));
        head.areas.push_back(text.big(4));
        text.until_nul();
        if (!text.empty()) throw std::runtime_error("an area goes on after its name");
    }
    return head;
}

/// Takes off the end of the file as well: what is left are the records.
inline DecodedHead ep_head(FileText& file, std::size_t record_hook_bytes) {
    DecodedHead head;
    const std::size_t whole = file.size(), blocks = file.little(2);
    if (whole != 1024 + 4096 * blocks) throw std::runtime_error("the file has another size");
    file.must(std::string(1, '\0'));
    head.picks = file.little(2);
    file.must(std::string(1, '\0'));
    head.names.name = without_nul(file.take(8));
    file.must(std::string(1, '\0'));
    head.function_bytes = file.little(1);
    file.must(std::string(15, '\0') + "\x12");
    head.areas = {file.little(2)};
    const std::size_t data = head.picks * (head.function_bytes + record_hook_bytes);
    const std::string records = file.take(data);
    if (32 + data > 4096 * blocks || 32 + data + 4096 <= 4096 * blocks) throw std::runtime_error("blocks");
    file.must(std::string(4096 * blocks - 32 - data, '\xff') + std::string(1022, '\0'));
    return head;
}

/// The bits of bytes as a text, in the order in which hooks count.
inline std::string bits_of(const std::string& bytes, bool least_first) {
    std::string bits;
    for (const char c : bytes) {
        unsigned value = static_cast<unsigned char>(c);
        std::string eight;
        for (int k = 0; k < 8; ++k, value /= 2) eight += value % 2 == 1 ? '1' : '0';
        if (!least_first) std::reverse(eight.begin(), eight.end());
        bits += eight;
    }
    return bits;
}

/// The places of one record as a text of 0 and 1, area by area.
inline std::string places_of(const std::string& bytes, const LoomProfile& profile) {
    const std::string bits = bits_of(bytes, profile.least_bit_first);
    std::string places;
    std::size_t at = 0;
    for (const HookArea& area : profile.areas) {
        places += bits.substr(at, area.hooks);
        at += area.hooks;
        while (profile.areas_on_bytes && at % 8 != 0) ++at;
    }
    return places;
}

inline std::size_t record_hook_bytes(const LoomProfile& profile) {
    std::size_t bits = 0;
    for (const HookArea& area : profile.areas)
        bits += profile.areas_on_bytes && area.hooks % 8 != 0 ? area.hooks + 8 - area.hooks % 8 : area.hooks;
    return bits / 8 + (bits % 8 == 0 ? 0 : 1);
}

inline std::vector<std::size_t> listed(const std::vector<HookRange>& ranges) {
    std::vector<std::size_t> hooks;
    for (const HookRange& range : ranges)
        for (std::size_t hook = range.first; hook <= range.last; ++hook) hooks.push_back(hook);
    return hooks;
}

/// Every hook that an end is tied to.
inline std::vector<std::size_t> tied_to(const LoomProfile& profile, std::size_t end, std::size_t ends) {
    std::vector<std::size_t> body = listed(profile.body);
    if (!profile.end_1_at_left) std::reverse(body.begin(), body.end());
    if (profile.hook_rule == HookRule::list) return {profile.hook_of_end[end]};
    std::vector<std::size_t> order;  // the end at each body hook
    for (std::size_t k = 0; k < ends; ++k) order.push_back(k);
    if (profile.hook_rule == HookRule::point)
        for (std::size_t k = ends - 1; k > 0; --k) order.push_back(k - 1);
    if (profile.hook_rule == HookRule::repeats) {
        const std::vector<std::size_t> once = order;
        for (std::size_t k = 1; k < profile.repeats; ++k) order.insert(order.end(), once.begin(), once.end());
    }
    std::vector<std::size_t> hooks;
    for (std::size_t place = 0; place < order.size(); ++place)
        if (order[place] == end) hooks.push_back(body[place]);
    return hooks;
}

inline std::vector<std::size_t> feeders_of(const LoomProfile& profile, const std::string& function_bits,
                                           const std::string& hooks) {
    const bool in_hooks = profile.feeder_encoding == FeederEncoding::hooks ||
                          profile.feeder_encoding == FeederEncoding::binary_hooks;
    const bool number = profile.feeder_encoding == FeederEncoding::binary ||
                        profile.feeder_encoding == FeederEncoding::binary_hooks;
    std::vector<std::size_t> found;
    std::size_t value = 0, weight = 1;
    for (std::size_t k = 0; k < profile.feeder_hooks.size(); ++k, weight *= 2) {
        if ((in_hooks ? hooks : function_bits).at(profile.feeder_hooks[k]) != '1') continue;
        value += weight;
        if (!number) found.push_back(k);
    }
    if (number && value > 0) found.push_back(value - 1);
    return found;
}

/// The records in the order in which they are woven, each as function bits and hooks (texts of 0 and 1, 1 =
/// lifted).
struct DecodedRecord {
    std::string function_bits, hooks;
};
inline std::vector<DecodedRecord> records_of(FileText& file, const DecodedHead& head,
                                             const LoomProfile& profile) {
    std::vector<DecodedRecord> records;
    for (std::size_t k = 0; k < head.picks; ++k) {
        DecodedRecord record;
        record.function_bits = bits_of(file.take(head.function_bytes), true);
        const std::string places = places_of(file.take(record_hook_bytes(profile)), profile);
        for (std::size_t hook = 0; hook < places.size(); ++hook) {
            const char bit = places[profile.hook_permutation.empty() ? hook : profile.hook_permutation[hook]];
            record.hooks += (bit == '1') == profile.lifted_is_one ? '1' : '0';
        }
        records.push_back(std::move(record));
    }
    if (!profile.pick_1_at_bottom) std::reverse(records.begin(), records.end());
    return records;
}

inline loomlink::DecodedFile decoded(const DecodedHead& head, const std::vector<DecodedRecord>& records,
                                     const LoomProfile& profile, std::size_t ends) {
    loomlink::DecodedFile read;
    read.names = head.names;
    read.lifts = loomlink::LiftTable(records.size(), profile.total_hooks);
    const std::size_t lead = profile.lead_in_picks;
    read.card = CardImage(records.size() - lead, ends);
    for (std::size_t k = 0; k < records.size(); ++k) {
        for (std::size_t hook = 0; hook < profile.total_hooks; ++hook)
            if (records[k].hooks.at(hook) == '1') read.lifts.lift(k, hook);
        if (k >= lead)
            read.feeders.push_back(feeders_of(profile, records[k].function_bits, records[k].hooks));
    }
    for (std::size_t end = 0; end < ends; ++end) {
        for (const std::size_t hook : tied_to(profile, end, ends))
            for (std::size_t pick = 0; pick < read.card.picks(); ++pick)
                if (records[lead + pick].hooks.at(hook) == '0') read.card.set(pick, end, true);
    }
    return read;
}

inline Result<loomlink::DecodedFile> test_decoder(std::string_view bytes, const LoomProfile& profile,
                                                  std::size_t ends) {
    try {
        FileText file(bytes), records(bytes);
        DecodedHead head;
        if (profile.output == OutputFormat::jc5) {
            head = jc5_head(file);
            records = file;
        } else if (profile.output == OutputFormat::ep) {
            head = ep_head(file, record_hook_bytes(profile));
            records.take(34);
        } else {
            head.function_bytes = profile.function_bytes;
            head.picks = bytes.size() / (head.function_bytes + record_hook_bytes(profile));
        }
        const auto read = records_of(records, head, profile);
        if (profile.output != OutputFormat::ep && !records.empty()) return bad_input("bytes are left over");
        return decoded(head, read, profile, ends);
    } catch (const std::exception& trouble) {
        return bad_input(trouble.what());
    }
}

}  // namespace weave::testing
