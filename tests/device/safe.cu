#include "safe.hpp"
