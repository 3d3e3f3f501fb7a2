#include <loomlink/service/fields.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace weave::loomlink {

namespace {

/// The largest number that JSON's readers agree on.
constexpr std::int64_t most = std::int64_t{1} << 53;

bool is_text(FieldKind kind) {
    return kind == FieldKind::text || kind == FieldKind::secret;
}

Status check_text(const Json& value, const Field& field, std::int64_t low, std::int64_t high) {
    if (!value.is_string()) return bad_input("must be a text", field.name);
    const auto& text = value.get_ref<const std::string&>();
    if (std::cmp_less(text.size(), low))
        return bad_input("must have at least " + counted(static_cast<std::size_t>(low), "byte"), field.name);
    if (std::cmp_greater(text.size(), high))
        return bad_input("must have at most " + counted(static_cast<std::size_t>(high), "byte"), field.name);
    if (!field.choices.empty() &&
        std::find(field.choices.begin(), field.choices.end(), text) == field.choices.end()) {
        std::string words;
        for (const auto& choice : field.choices) words += (words.empty() ? "" : ", ") + choice;
        return bad_input("must be one of: " + words, field.name);
    }
    return {};
}

Status check_integer(const Json& value, const Field& field) {
    const bool fits = value.is_number_unsigned() ? value.get<std::uint64_t>() <= std::uint64_t(most)
                                                 : value.is_number_integer();
    if (!fits) return bad_input("must be a whole number", field.name);
    const auto number = value.get<std::int64_t>();
    if (number < field.low || number > field.high)
        return bad_input("must be from " + std::to_string(field.low) + " to " + std::to_string(field.high),
                         field.name);
    return {};
}

Status check_number(const Json& value, const Field& field) {
    if (!value.is_number()) return bad_input("must be a number", field.name);
    const auto number = value.get<double>();
    if (!(number >= static_cast<double>(field.low) && number <= static_cast<double>(field.high)))
        return bad_input("must be from " + std::to_string(field.low) + " to " + std::to_string(field.high),
                         field.name);
    return {};
}

/// Entries of lists: texts of 1 to 200 bytes, numbers from 1 on.
Status check_list(const Json& value, const Field& field) {
    if (!value.is_array()) return bad_input("must be a list", field.name);
    if (std::cmp_less(value.size(), field.low) || std::cmp_greater(value.size(), field.high))
        return bad_input(
            "must have " + std::to_string(field.low) + " to " + std::to_string(field.high) + " entries",
            field.name);
    Field entry = field;
    entry.low = 1;
    entry.high = field.kind == FieldKind::texts ? 200 : most;
    for (std::size_t k = 0; k < value.size(); ++k) {
        entry.name = indexed(field.name, k);
        WEAVE_CHECK_OK(field.kind == FieldKind::texts ? check_text(value[k], entry, entry.low, entry.high)
                                                      : check_integer(value[k], entry));
    }
    return {};
}

Status check_value(const Json& value, const Field& field) {
    switch (field.kind) {
        case FieldKind::text:
        case FieldKind::secret:
            return check_text(value, field, field.low, field.high);
        case FieldKind::integer:
            return check_integer(value, field);
        case FieldKind::number:
            return check_number(value, field);
        case FieldKind::yes_or_no:
            return value.is_boolean() ? Status() : Status(bad_input("must be true or false", field.name));
        case FieldKind::texts:
        case FieldKind::integers:
            return check_list(value, field);
        case FieldKind::document:
            break;
    }
    if (value.is_object()) return {};
    return check_text(value, field, field.low, field.high);
}

/// All of `given` held to the fields; what is null counts as missing.
Result<Json> checked(const Json& given, const Fields& fields) {
    Json read = Json::object();
    for (const auto& [name, value] : given.items()) {
        const auto field = std::find_if(fields.begin(), fields.end(),
                                        [&name = name](const Field& f) { return f.name == name; });
        if (field == fields.end()) return bad_input("is not known here", on_one_line(name));
        if (value.is_null()) continue;
        WEAVE_CHECK_OK(check_value(value, *field));
        read[name] = value;
    }
    for (const Field& field : fields)
        if (field.required && !read.contains(field.name)) return bad_input("is missing", field.name);
    return read;
}

/// A parameter's text as the value that it stands for; nothing where it stands for none.
std::optional<Json> value_of(const std::string& text, const Field& field) {
    if (is_text(field.kind)) return Json(text);
    if (const auto whole = parse_whole(text)) return Json(*whole);
    return {};
}

}  // namespace

Field optional(Field field) {
    field.required = false;
    return field;
}

Result<Json> read_body(std::string_view body, const Fields& fields) {
    const auto read = parse_json(body);
    if (!read) return bad_input("the body is not JSON");  // what the parser says repeats what it read
    const Json& given = *read;
    if (!given.is_object()) return bad_input("the body must be a JSON object");
    return checked(given, fields);
}

Result<Json> read_query(const net::Parameters& query, const Fields& fields) {
    Json given = Json::object();
    for (const auto& [name, text] : query) {
        if (given.contains(name)) return bad_input("is given twice", on_one_line(name));
        const auto field = std::find_if(fields.begin(), fields.end(),
                                        [&name = name](const Field& f) { return f.name == name; });
        if (field == fields.end()) return bad_input("is not known here", on_one_line(name));
        const auto value = value_of(text, *field);
        if (!value) return bad_input("must be a whole number", name);
        given[name] = *value;
    }
    return checked(given, fields);
}

Json schema_of(const Field& field) {
    Json schema{{"description", field.description}};
    switch (field.kind) {
        case FieldKind::text:
        case FieldKind::secret:
            schema["type"] = "string";
            schema["minLength"] = std::min<std::int64_t>(field.low, 1);  // JSON Schema counts characters
            schema["maxLength"] = field.high;
            if (field.kind == FieldKind::secret) schema["format"] = "password";
            if (!field.choices.empty()) schema["enum"] = field.choices;
            break;
        case FieldKind::integer:
        case FieldKind::number:
            schema["type"] = field.kind == FieldKind::integer ? "integer" : "number";
            schema["minimum"] = field.low;
            schema["maximum"] = field.high;
            break;
        case FieldKind::yes_or_no:
            schema["type"] = "boolean";
            break;
        case FieldKind::texts:
        case FieldKind::integers: {
            Json entry{{"type", field.kind == FieldKind::texts ? "string" : "integer"}};
            if (!field.choices.empty()) entry["enum"] = field.choices;
            schema["type"] = "array";
            schema["items"] = std::move(entry);
            schema["minItems"] = field.low;
            schema["maxItems"] = field.high;
            break;
        }
        case FieldKind::document:
            schema["type"] = Json::array({"string", "object"});
            break;
    }
    return schema;
}

Json schema_of(const Fields& fields) {
    Json properties = Json::object(), required = Json::array();
    for (const Field& field : fields) {
        properties[field.name] = schema_of(field);
        if (field.required) required.push_back(field.name);
    }
    return {{"type", "object"},
            {"properties", std::move(properties)},
            {"required", std::move(required)},
            {"additionalProperties", false}};
}

}  // namespace weave::loomlink
