// The whole command, with the methods that the program registers. Component apps.
#pragma once

#include "apps/command.hpp"
