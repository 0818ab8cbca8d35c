#include "tools/program/command_line.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <utility>

namespace reradiant {

namespace {

CLI::Validator number_check(const char* description, bool (*holds)(double)) {
    return {[description, holds](const std::string& text) {
                double value = 0.0;
                const bool is_number = CLI::detail::lexical_cast(text, value);
                return is_number && holds(value) ? std::string{}
                                                 : "'" + text + "' is not a " + description;
            },
            description};
}

std::vector<CLI::App*> commands_of(CLI::App& program) {
    return program.get_subcommands([](CLI::App*) { return true; });
}

} // namespace

CommandOption& CommandOption::required() {
    option_->required();
    return *this;
}

CommandOption& CommandOption::show_default() {
    option_->capture_default_str();
    return *this;
}

CommandOption& CommandOption::non_negative() {
    option_->check(number_check("number of 0 or more", [](double value) { return value >= 0.0; }));
    return *this;
}

CommandOption& CommandOption::positive() {
    option_->check(number_check("positive number", [](double value) { return value > 0.0; }));
    return *this;
}

template <typename Number>
CommandOption& CommandOption::in_range(Number lowest, Number highest) {
    option_->check(CLI::Range(lowest, highest));
    return *this;
}

CommandOption& CommandOption::one_of(std::vector<std::string> words) {
    option_->check(CLI::IsMember(std::move(words)));
    return *this;
}

CommandOption& CommandOption::delimiter(char character) {
    option_->delimiter(character);
    return *this;
}

CommandOption& CommandOption::one_at_a_time() {
    option_->allow_extra_args(false);
    return *this;
}

CommandOption& CommandOption::excludes(const CommandOption& other) {
    option_->excludes(other.option_);
    return *this;
}

CommandOption& CommandOption::group(const std::string& heading) {
    option_->group(heading);
    return *this;
}

CommandOption& CommandOption::environment(const std::string& variable) {
    option_->envname(variable);
    return *this;
}

CommandOption& CommandOption::when_given(std::function<void()> call) {
    option_->each([call = std::move(call)](const std::string&) { call(); });
    return *this;
}

template <typename Value>
CommandOption Command::option(const std::string& names, Value& value,
                              const std::string& description) {
    return CommandOption(app_->add_option(names, value, description));
}

CommandOption Command::flag(const std::string& names, bool& value, const std::string& description) {
    return CommandOption(app_->add_flag(names, value, description));
}

Command Command::one_of_group(const std::string& name) {
    CLI::App* const group = app_->add_option_group(name);
    group->require_option(1);
    return Command(group);
}

void Command::version(const std::string& text) {
    app_->set_version_flag("--version", text);
}

void Command::footer(const std::string& text) {
    app_->footer(text);
}

void Command::callback(std::function<void()> run) {
    app_->callback(std::move(run));
}

void Command::before_callback(std::function<void()> prepare) {
    app_->parse_complete_callback(std::move(prepare));
}

Program::Program(const std::string& description, const std::string& name,
                 const std::string& version)
    : app_(std::make_unique<CLI::App>(description, name)) {
    app_->set_version_flag("--version", version);
    app_->require_subcommand(1);
}

Program::~Program() = default;

Command Program::add_command(const std::string& name, const std::string& description) {
    return Command(app_->add_subcommand(name, description));
}

std::vector<Command> Program::commands() const {
    std::vector<Command> commands;
    for (CLI::App* const command : commands_of(*app_))
        commands.emplace_back(command);
    return commands;
}

std::vector<std::string> Program::command_names() const {
    std::vector<std::string> names;
    for (const CLI::App* const command : commands_of(*app_))
        names.push_back(command->get_name());
    return names;
}

void Program::footer(const std::string& text) {
    app_->footer(text);
}

void Program::parse_and_run(int argc, const char* const* argv) {
    try {
        app_->parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0)
            throw CommandLineError(error.what());
        app_->exit(error); // --help and --version
    }
}

template CommandOption& CommandOption::in_range(int, int);
template CommandOption& CommandOption::in_range(unsigned, unsigned);
template CommandOption& CommandOption::in_range(std::size_t, std::size_t);

template CommandOption Command::option(const std::string&, int&, const std::string&);
template CommandOption Command::option(const std::string&, long&, const std::string&);
template CommandOption Command::option(const std::string&, unsigned&, const std::string&);
template CommandOption Command::option(const std::string&, std::size_t&, const std::string&);
template CommandOption Command::option(const std::string&, double&, const std::string&);
template CommandOption Command::option(const std::string&, std::string&, const std::string&);
template CommandOption Command::option(const std::string&, std::filesystem::path&,
                                       const std::string&);
template CommandOption Command::option(const std::string&, std::optional<int>&, const std::string&);
template CommandOption Command::option(const std::string&, std::optional<std::size_t>&,
                                       const std::string&);
template CommandOption Command::option(const std::string&, std::optional<double>&,
                                       const std::string&);
template CommandOption Command::option(const std::string&, std::vector<std::string>&,
                                       const std::string&);
template CommandOption Command::option(const std::string&, std::vector<double>&,
                                       const std::string&);
template CommandOption Command::option(const std::string&, std::vector<std::filesystem::path>&,
                                       const std::string&);

} // namespace reradiant
