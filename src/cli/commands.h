// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

// One function for each command, each in its own file. They print, and return the program's exit code.

int run_serve(const ServeArguments& arguments);
int run_import(const ImportArguments& arguments);
int run_import_home(const ImportHomeArguments& arguments);
int run_search(const SearchArguments& arguments);
int run_show(const ShowArguments& arguments);
int run_set(const SetArguments& arguments);
int run_reset(const ResetArguments& arguments);
int run_history(const HistoryArguments& arguments);
int run_undo(const UndoArguments& arguments);
int run_simulate(const SimulateArguments& arguments);
int run_check(const CheckArguments& arguments);
int run_classify(const ClassifyArguments& arguments);
int run_attributes(const AttributesArguments& arguments);
int run_evaluate(const EvaluateArguments& arguments);
int run_scene(const SceneArguments& arguments);
int run_bench(const BenchArguments& arguments);

}  // namespace embody::cli
