// What a database of PostgreSQL says of itself, by the server's own catalogues.
#include <weave/sql/postgres_connection.hpp>

namespace weave::sql {

namespace {

// What an extension brought along is the server's own.
#define WEAVE_NOT_OF_EXTENSION(oid) " AND NOT EXISTS (SELECT 1 FROM pg_depend e WHERE e.objid = " oid " AND e.deptype = 'e')"

constexpr const char* tables_here =
    "FROM pg_class t WHERE t.relnamespace = current_schema()::regnamespace AND t.relkind IN ('r', 'p')" WEAVE_NOT_OF_EXTENSION("t.oid");

constexpr const char* clear_all =
    "DO $$ DECLARE thing text; BEGIN "
    "FOR thing IN SELECT t.oid::regclass FROM pg_class t WHERE t.relnamespace = current_schema()::regnamespace AND t.relkind IN "
    "('r', 'p')" WEAVE_NOT_OF_EXTENSION("t.oid") " LOOP EXECUTE 'DROP TABLE ' || thing || ' CASCADE'; END LOOP; "
    "FOR thing IN SELECT p.oid::regprocedure FROM pg_proc p WHERE p.pronamespace = "
    "current_schema()::regnamespace" WEAVE_NOT_OF_EXTENSION("p.oid") " LOOP EXECUTE 'DROP FUNCTION ' || thing || ' CASCADE'; END LOOP; "
    "END $$";

/// Each tells a part of the schema, the stamp apart.
constexpr const char* parts_of_schema[]{
    "SELECT 'column ' || t.relname || '.' || a.attname || ': ' || format_type(a.atttypid, a.atttypmod) || ' ' || "
    "coalesce(c.collname, '') || CASE WHEN a.attnotnull THEN ' not null' ELSE '' END FROM pg_class t JOIN pg_attribute a ON "
    "a.attrelid = t.oid LEFT JOIN pg_collation c ON c.oid = a.attcollation WHERE t.relnamespace = current_schema()::regnamespace "
    "AND t.relkind IN ('r', 'p', 'v', 'm', 'f') AND a.attnum > 0 AND NOT a.attisdropped AND t.relname <> "
    "'store_version'" WEAVE_NOT_OF_EXTENSION("t.oid"),
    "SELECT 'constraint ' || k.conname || ' of ' || t.relname || ': ' || pg_get_constraintdef(k.oid) || CASE WHEN k.convalidated "
    "THEN '' ELSE ' not valid' END FROM pg_constraint k JOIN pg_class t ON t.oid = k.conrelid WHERE k.connamespace = "
    "current_schema()::regnamespace AND t.relname <> 'store_version'",
    "SELECT 'index ' || indexname || ': ' || replace(indexdef, quote_ident(schemaname) || '.', '') FROM pg_indexes WHERE "
    "schemaname = current_schema() AND tablename <> 'store_version'",
    "SELECT 'trigger ' || g.tgname || ' of ' || t.relname || ': ' || CASE WHEN g.tgisinternal THEN '' ELSE "
    "pg_get_triggerdef(g.oid, true) END || CASE g.tgenabled WHEN 'O' THEN '' ELSE ' asleep' END FROM pg_trigger g JOIN pg_class t "
    "ON t.oid = g.tgrelid WHERE t.relnamespace = current_schema()::regnamespace AND (NOT g.tgisinternal OR g.tgenabled <> 'O')",
    "SELECT 'function ' || p.proname || ': ' || p.prosrc || CASE WHEN p.prosecdef THEN ' as its owner' ELSE '' END FROM pg_proc p "
    "WHERE p.pronamespace = current_schema()::regnamespace" WEAVE_NOT_OF_EXTENSION("p.oid"),
    "SELECT 'rewriting ' || rulename || ' of ' || tablename || ': ' || definition FROM pg_rules WHERE schemaname = current_schema() "
    "AND rulename <> '_RETURN'",
};

/// For each foreign key its name, its table, the table that it points at, and a question for the rows that point nowhere.
constexpr const char* dangling_questions =
    "SELECT k.conname, k.conrelid::regclass::text, k.confrelid::regclass::text, format('SELECT count(*) FROM %s c WHERE %s AND NOT "
    "EXISTS (SELECT 1 FROM %s p WHERE %s)', k.conrelid::regclass, string_agg(format('c.%I IS NOT NULL', a.attname), ' AND '), "
    "k.confrelid::regclass, string_agg(format('p.%I = c.%I', b.attname, a.attname), ' AND ')) FROM pg_constraint k CROSS JOIN "
    "LATERAL unnest(k.conkey, k.confkey) AS pair (here, there) JOIN pg_attribute a ON a.attrelid = k.conrelid AND a.attnum = "
    "pair.here JOIN pg_attribute b ON b.attrelid = k.confrelid AND b.attnum = pair.there WHERE k.contype = 'f' AND k.connamespace "
    "= current_schema()::regnamespace GROUP BY k.oid, k.conname, k.conrelid, k.confrelid ORDER BY 2, 1";

}  // namespace

Result<Stamp> PostgresConnection::stamp() {
    WEAVE_TRY(const std::int64_t known,
              number("SELECT count(*) FROM pg_tables WHERE schemaname = current_schema() AND tablename = 'store_version'"));
    if (known == 0) return Stamp();
    WEAVE_TRY(const auto found, one("SELECT application, version FROM store_version", [](const Row& row) {
                  return Stamp{row.integer(0), row.integer(1)};
              }));
    return found.value_or(Stamp());
}

Status PostgresConnection::set_stamp(const Stamp& stamp) {
    WEAVE_CHECK_OK(
        script("CREATE TABLE IF NOT EXISTS store_version (one bigint PRIMARY KEY CHECK (one = 1), application bigint NOT NULL, "
               "version bigint NOT NULL)"));
    return run("INSERT INTO store_version (one, application, version) VALUES (1, ?, ?) ON CONFLICT (one) DO UPDATE SET "
               "application = excluded.application, version = excluded.version",
               stamp.application, stamp.version);
}

Result<bool> PostgresConnection::is_empty() {
    WEAVE_TRY(const std::int64_t tables, number(std::string("SELECT count(*) ") + tables_here));
    return tables == 0;
}

/// The server looks at the checksums of its pages itself, as they are read (initdb --data-checksums).
Status PostgresConnection::inspect_pages(const Find&) {
    return {};
}

Status PostgresConnection::clear() {
    return script(clear_all);
}

Status PostgresConnection::inspect_links(const Find& find) {
    struct Link {
        std::string name, table, other, question;
    };
    WEAVE_TRY(const auto links, all(dangling_questions, [](const Row& row) {
                  return Link{row.bytes(0), row.bytes(1), row.bytes(2), row.bytes(3)};
              }));
    for (const Link& link : links) {
        WEAVE_TRY(const std::int64_t count, number(link.question));
        if (count > 0) find(link.table, "points at a row of " + link.other + " that is not there, in " + std::to_string(count) + " of its rows");
    }
    return {};
}

Result<std::set<std::string>> PostgresConnection::rules() {
    std::set<std::string> rules;
    for (const char* part : parts_of_schema)
        WEAVE_CHECK_OK(each(part, [&](const Row& row) { rules.insert(row.bytes(0)); }));
    return rules;
}

Result<std::unique_ptr<Connection>> PostgresConnection::scratch() {
    WEAVE_TRY(auto fresh, open_postgres(m_place, Access::write, m_patience));
    WEAVE_CHECK_OK(fresh->script("BEGIN"));
    Status made = fresh->script("CREATE SCHEMA weave_scratch; SET LOCAL search_path = weave_scratch");
    if (!made) return std::move(made).error();
    return fresh;
}

Status PostgresConnection::load(const std::function<Status()>& fill) {
    WEAVE_TRY(const auto tables, all(std::string("SELECT quote_ident(t.relname) ") + tables_here,
                                     [](const Row& row) { return row.bytes(0); }));
    for (const std::string& table : tables) WEAVE_CHECK_OK(script("ALTER TABLE " + table + " DISABLE TRIGGER USER"));
    WEAVE_CHECK_OK(fill());
    for (const std::string& table : tables) WEAVE_CHECK_OK(script("ALTER TABLE " + table + " ENABLE TRIGGER USER"));
    return {};
}

}  // namespace weave::sql
