#include <weave/ranks/mpi/mpi_comm.hpp>

#include <cstdlib>

namespace weave::ranks {

bool is_one_of_many() {
    return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
}

Result<std::unique_ptr<Comm>> join_others(std::chrono::seconds, std::function<void(const std::string&)>) {
    return system_fault("this program was built without Open MPI, so processes cannot relax one cloth together: run it without mpirun");
}

}  // namespace weave::ranks
