// SPDX-License-Identifier: MIT
#include "cli/commands.h"
#include "cli/output.h"
#include "foundation/heap.h"

namespace embody::cli {
namespace {

struct Runner {
    int operator()(const ServeArguments& arguments) const { return run_serve(arguments); }
    int operator()(const ImportArguments& arguments) const { return run_import(arguments); }
    int operator()(const ImportHomeArguments& arguments) const { return run_import_home(arguments); }
    int operator()(const SearchArguments& arguments) const { return run_search(arguments); }
    int operator()(const ShowArguments& arguments) const { return run_show(arguments); }
    int operator()(const SetArguments& arguments) const { return run_set(arguments); }
    int operator()(const ResetArguments& arguments) const { return run_reset(arguments); }
    int operator()(const HistoryArguments& arguments) const { return run_history(arguments); }
    int operator()(const UndoArguments& arguments) const { return run_undo(arguments); }
    int operator()(const SimulateArguments& arguments) const { return run_simulate(arguments); }
    int operator()(const CheckArguments& arguments) const { return run_check(arguments); }
    int operator()(const ClassifyArguments& arguments) const { return run_classify(arguments); }
    int operator()(const AttributesArguments& arguments) const { return run_attributes(arguments); }
    int operator()(const EvaluateArguments& arguments) const { return run_evaluate(arguments); }
    int operator()(const SceneArguments& arguments) const { return run_scene(arguments); }
    int operator()(const BenchArguments& arguments) const { return run_bench(arguments); }
};

}  // namespace
}  // namespace embody::cli

int main(int count, char** words) {
    embody::keep_freed_memory();
    const embody::cli::Parsed parsed = embody::cli::parse_arguments(count, words);
    const int code = parsed.arguments ? std::visit(embody::cli::Runner{}, *parsed.arguments) : parsed.exit_code;
    return embody::cli::finish_output(code);
}
