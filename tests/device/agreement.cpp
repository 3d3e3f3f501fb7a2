#include "agreement.hpp"
