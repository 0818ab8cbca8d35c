#include "host/base/atomic_file.h"
#include "host/base/logging.h"
#include "host/report/json_file.h"
#include "host/scene/document/load_state.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"
#include "tools/commands/material_tree.h"
#include "tools/program/command.h"
#include "tools/program/outputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>
#include <memory>

#include <unistd.h>

namespace reradiant {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* TREE =
    R"(The questions, after Weidlich and Wilkie's tutorial of 2011 (they do not lead to c and e: name these by
--class):
  reflects environment? yes -> environment blurred? yes -> smooth / metallic, smooth (d)
                                                    no  -> highlight small? yes -> smooth / metallic, smooth (d)
                                                                            no  -> one highlight?
                        no  -> highlight small? yes -> smooth / coloured (a, b)
                                                no  -> one highlight?
  one highlight? yes -> rough / metallic, smooth (f);  no -> rough / metallic, rough (g, h)
Example: reradiant classify --reflects-environment no --highlight-small yes -o start.toml)";

struct ClassifyOptions {
    std::array<std::string, QUESTION_COUNT> answers; ///< as given; empty: not given
    std::string letter;
    fs::path output;
};

bool is_yes(const std::string& text, const std::string& option) {
    for (const char* word : {"yes", "y", "true"})
        if (text == word)
            return true;
    for (const char* word : {"no", "n", "false"})
        if (text == word)
            return false;
    throw_input_error({}, fmt::format("--{} is \"{}\"", option, text), "answer yes or no");
}

/// Returns the answer from the command line, else from whoever sits at the terminal.
bool answer_to(Question question, const ClassifyOptions& options) {
    const auto index = static_cast<std::size_t>(question);
    const QuestionText& text = question_texts().at(index);
    std::string answer = options.answers.at(index);
    if (answer.empty() && ::isatty(STDIN_FILENO) == 1) {
        fmt::print("{} (yes or no) ", text.sentence);
        std::fflush(stdout);
        std::getline(std::cin, answer);
    }
    if (answer.empty())
        throw_input_error({}, fmt::format("--{} is not answered: {}", text.option, text.sentence),
                          fmt::format("give --{} yes or --{} no", text.option, text.option));
    return is_yes(answer, text.option);
}

/// Every answer is a yes or a no, whether the tree asks for it or not.
void check_answers(const ClassifyOptions& options) {
    const auto& texts = question_texts();
    for (std::size_t i = 0; i < QUESTION_COUNT; ++i)
        if (!options.answers[i].empty())
            is_yes(options.answers[i], texts[i].option);
    const auto given = [&](Question question, bool yes) {
        const auto i = static_cast<std::size_t>(question);
        return !options.answers[i].empty() && is_yes(options.answers[i], texts[i].option) == yes;
    };
    if (given(Question::ReflectsEnvironment, false) && given(Question::EnvironmentBlurred, true))
        throw_input_error({},
                          "--environment-blurred yes contradicts --reflects-environment no: what "
                          "is not reflected is not blurred",
                          "change one of the two");
    const bool any = std::any_of(options.answers.begin(), options.answers.end(),
                                 [](const std::string& text) { return !text.empty(); });
    if (any && !options.letter.empty())
        throw_input_error({}, "both --class and answers are given", "give either");
}

Classification classify(const ClassifyOptions& options) {
    if (!options.letter.empty())
        return {"", "", options.letter};
    const Classification result =
        classify_material([&](Question question) { return answer_to(question, options); });
    for (std::size_t i = 0; i < QUESTION_COUNT; ++i)
        if (!options.answers.at(i).empty() &&
            std::find(result.asked.begin(), result.asked.end(), static_cast<Question>(i)) ==
                result.asked.end())
            logging::warn("--{} makes no difference: the tree does not ask it here",
                          question_texts().at(i).option);
    return result;
}

Json describe(const Classification& result) {
    Json json = Json::object();
    if (!result.top.empty()) {
        json["top"] = result.top;
        json["base"] = result.base;
    }
    for (const char letter : result.letters) {
        const MaterialClass& c = material_class(letter);
        json["classes"].push_back({{"letter", std::string(1, letter)},
                                   {"name", c.name},
                                   {"ranges", c.ranges},
                                   {"presets", c.presets}});
    }
    return json;
}

void print(const Classification& result, const std::string& preset) {
    if (!result.top.empty())
        fmt::print("top layer: {}\nbase: {}\n", result.top, result.base);
    for (const char letter : result.letters) {
        const MaterialClass& c = material_class(letter);
        fmt::print("class {}: {} ({})\n  presets: {}\n", letter, c.name, c.ranges,
                   fmt::join(c.presets, ", "));
    }
    fmt::print("start from: {}\n", preset);
}

int run_classify(const ClassifyOptions& options, const CommonOptions& common) {
    check_answers(options);
    check_outputs(common, {{"-o", options.output, {".toml"}}});
    const Classification result = classify(options);
    const std::string preset = material_class(result.letters.front()).presets.front();
    const fs::path file = spectra_directory() / "materials" / (preset + ".toml");
    const std::string material = read_file(file, {file.string()});
    Json json = describe(result);
    json["preset"] = preset;
    json["material"] = material;
    write_json(common.json, json);
    if (!options.output.empty())
        write_text_atomically(options.output, material);
    print(result, preset);
    if (options.output.empty())
        fmt::print("\n{}", material);
    else if (!common.quiet)
        fmt::print("written: {}\n", options.output.string());
    return 0;
}

} // namespace

void add_classify_command(Program& program, CommandContext& context) {
    auto options = std::make_shared<ClassifyOptions>();
    Command command = program.add_command(
        "classify", "Finds the class, presets and starting parameters of a material by its looks");
    for (std::size_t i = 0; i < QUESTION_COUNT; ++i) {
        const QuestionText& text = question_texts().at(i);
        command.option(
            fmt::format("--{}", text.option), options->answers.at(i),
            fmt::format("{} yes or no; asked at a terminal when left out", text.sentence));
    }
    command.option("--class", options->letter, "leave out the questions: a class a to h")
        .one_of({"a", "b", "c", "d", "e", "f", "g", "h"});
    command.option("-o,--output", options->output,
                   "write the starting parameters as MATERIAL.toml");
    command.footer(TREE);
    command.callback(
        [options, &context] { context.exit_code = run_classify(*options, context.common); });
}

} // namespace reradiant
