#include "errors.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace py = pybind11;

namespace alhazen::python {

namespace {

/// An option of the command line and the argument of Scene.render with its value.
struct Argument {
    std::string_view option, name;
};

constexpr std::array<Argument, 9> kArguments = {{{"--antialias", "antialias"},
                                                 {"--aov", "layers"},
                                                 {"--environment", "environment"},
                                                 {"--filter", "filter"},
                                                 {"--noise", "noise"},
                                                 {"--sampler", "sampler"},
                                                 {"--spp", "spp"},
                                                 {"--time-limit", "time_limit"},
                                                 {"--view", "view"}}};

bool is_of_word(char c) {
    return c == '-' || (c >= 'a' && c <= 'z');
}

/// Classes in the order of ErrorKind.
constexpr const char* kClasses[] = {"RenderError", "UsageError", "SceneError", "FileError",
                                    "ResourceError"};

void raise_as_python(const Error& error, const FileLocation& where) {
    const py::object type =
        py::module_::import("alhazen._errors").attr(kClasses[static_cast<int>(error.kind())]);
    const auto text = [](const std::string& s) {
        return py::reinterpret_steal<py::object>(
            PyUnicode_DecodeUTF8(s.data(), static_cast<Py_ssize_t>(s.size()), "backslashreplace"));
    };
    const auto number = [](int n) { return n > 0 ? py::object(py::int_(n)) : py::none(); };
    const py::object value = type(text(with_arguments(error.what())),
                                  where.file.empty() ? py::object(py::none()) : text(where.file),
                                  number(where.line), number(where.column));
    PyErr_SetObject(type.ptr(), value.ptr());
}

}  // namespace

std::string with_arguments(std::string_view message) {
    std::string result;
    while (!message.empty()) {
        const std::size_t begin = std::min(message.find("--"), message.size());
        std::size_t end = begin;
        while (end < message.size() && is_of_word(message[end])) ++end;
        const std::string_view option = message.substr(begin, end - begin);
        const auto* const known =
            std::find_if(kArguments.begin(), kArguments.end(),
                         [&](const Argument& argument) { return argument.option == option; });
        result += message.substr(0, begin);
        const bool begins_word = begin == 0 || std::string_view(" '(\n").find(message[begin - 1]) !=
                                                   std::string_view::npos;
        result += known == kArguments.end() || !begins_word ? option : known->name;
        message.remove_prefix(end);
    }
    return result;
}

void translate_errors() {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const FoundErrors& found) {
            raise_as_python(found, found.first());
        } catch (const Error& error) {
            raise_as_python(error, error.location());
        }
    });
}

void throw_found(const Diagnostics& found) {
    for (const Diagnostic& diagnostic : found.all()) {
        if (diagnostic.severity != Severity::Error) continue;
        try {
            found.throw_if_errors();
        } catch (const Error& all) {
            throw FoundErrors(all, diagnostic.location);
        }
    }
}

Diagnostics at_origins(const Diagnostics& found, const std::string& name, const Origins& origins) {
    Diagnostics result;
    for (const Diagnostic& diagnostic : found.all()) {
        FileLocation where = diagnostic.location;
        const auto line = static_cast<std::size_t>(where.line);
        if (where.file == name)
            where = line - 1 < origins.size() ? origins[line - 1] : FileLocation{};
        if (diagnostic.severity == Severity::Error) {
            result.error(std::move(where), diagnostic.message);
        } else {
            result.warning(std::move(where), diagnostic.message);
        }
    }
    return result;
}

}  // namespace alhazen::python
