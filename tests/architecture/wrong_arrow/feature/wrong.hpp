// Breaks two rules, for the test of the check.
#pragma once

#include <sqlite3.h>

#include "posevote/recognize/recognizer.hpp"
