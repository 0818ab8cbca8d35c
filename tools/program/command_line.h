#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace reradiant {

/// The options of the program's commands, read by CLI11. Its headers take longer to compile than
/// any command, so that command_line.cpp alone includes them.

/// A mistake in a command line, without the name of the program.
class CommandLineError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// An option or a positional argument; each function returns the option itself.
class CommandOption {
public:
    explicit CommandOption(CLI::Option* option) : option_(option) {}

    CommandOption& required();
    /// The help shows the value that the variable has now.
    CommandOption& show_default();
    /// Numbers of 0 or more, or above 0; "nan", which no comparison finds too small, is neither.
    CommandOption& non_negative();
    CommandOption& positive();
    /// Number is int, unsigned or std::size_t.
    template <typename Number>
    CommandOption& in_range(Number lowest, Number highest);
    CommandOption& one_of(std::vector<std::string> words);
    /// One text holds several values.
    CommandOption& delimiter(char character);
    /// Of an option with several values: it takes the one behind its name, and is repeated for
    /// more. Positional arguments may follow it.
    CommandOption& one_at_a_time();
    CommandOption& excludes(const CommandOption& other);
    /// The heading that the help lists it under.
    CommandOption& group(const std::string& heading);
    /// The environment variable that has the value when the command line has none.
    CommandOption& environment(const std::string& variable);
    CommandOption& when_given(std::function<void()> call);

private:
    CLI::Option* option_;
};

/// A sub-command, or a group of its options.
class Command {
public:
    explicit Command(CLI::App* app) : app_(app) {}

    /// Names are as in "-o,--output", or without hyphens for a positional argument. Value is one of
    /// the types at the end of command_line.cpp. The variable must live until the command has run.
    template <typename Value>
    CommandOption option(const std::string& names, Value& value, const std::string& description);
    CommandOption flag(const std::string& names, bool& value, const std::string& description);
    /// A group of options, exactly one of which must be given.
    Command one_of_group(const std::string& name);
    /// --version, which prints this text and ends the program.
    void version(const std::string& text);
    /// The last words of the help.
    void footer(const std::string& text);
    /// `run` is called when the command was given, `prepare` just before.
    void callback(std::function<void()> run);
    void before_callback(std::function<void()> prepare);

private:
    CLI::App* app_;
};

/// The program: one of its commands must be given.
class Program {
public:
    Program(const std::string& description, const std::string& name, const std::string& version);
    ~Program();

    Command add_command(const std::string& name, const std::string& description);
    std::vector<Command> commands() const;
    std::vector<std::string> command_names() const;
    void footer(const std::string& text);
    /// Runs the command that is given, or prints the help or the version that is asked for. Throws
    /// CommandLineError, and whatever the command does.
    void parse_and_run(int argc, const char* const* argv);

private:
    std::unique_ptr<CLI::App> app_;
};

} // namespace reradiant
