// In the place of postgres*.cpp where libpq is missing.
#include <weave/sql/postgres.hpp>

namespace weave::sql {

namespace {

Error built_without() {
    return system_fault("this program was built without PostgreSQL (libpq): install libpq-dev and build it again");
}

}  // namespace

Result<std::unique_ptr<Connection>> open_postgres(const std::string&, Access, std::chrono::milliseconds) {
    return built_without();
}

Result<std::vector<std::string>> servers_of(const std::string&) {
    return built_without();
}

}  // namespace weave::sql
