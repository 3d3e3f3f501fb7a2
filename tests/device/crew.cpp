#include "crew.hpp"
