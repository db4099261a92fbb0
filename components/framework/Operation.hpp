#pragma once
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "components/framework/Activity.hpp"
#include "components/framework/ConfigReader.hpp"
#include "components/framework/PropertyList.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** An operation, callable by name with arguments as text. */
class OperationBase {
public:
    OperationBase(TaskContext* owner, std::string name, std::string doc)
        : owner_(owner), name_(std::move(name)), doc_(std::move(doc)) {
        owner->enlist(this);
    }
    virtual ~OperationBase() = default;
    OperationBase(const OperationBase&) = delete;
    OperationBase& operator=(const OperationBase&) = delete;
    const std::string& name() const { return name_; }
    const std::string& doc() const { return doc_; }
    TaskContext& owner() const { return *owner_; }

    /** "double(double, text)" */
    virtual std::string signature() const = 0;
    /** Calls with arguments in YAML and gives the result as text; types::ConfigError when they do not fit. */
    virtual std::string callText(const std::vector<std::string>& arguments) = 0;

protected:
    /** Throws types::ConfigError when there are not `taken`. */
    void requireCount(const std::vector<std::string>& arguments, size_t taken) const;

private:
    TaskContext* owner_;
    std::string name_, doc_;
};

inline void OperationBase::requireCount(const std::vector<std::string>& arguments, size_t taken) const {
    if (arguments.size() != taken)
        throw types::ConfigError("", name_, fmt::format("has {} arguments, takes {}", arguments.size(), signature()));
}

template <class Signature>
class Operation;

/** A function of a task that others call; it runs on the task's own thread, in every state of the task.
 *
 *      framework::Operation<double(double)> turn{this, "turn", "turns the head to a bearing [rad]",
 *                                                [this](double bearing) { return head_.turn(bearing); }};
 *
 *  What it throws reaches the caller; the task's state is left alone. Argument types are those of properties. */
template <class R, class... Args>
class Operation<R(Args...)> final : public OperationBase {
public:
    Operation(TaskContext* owner, std::string name, std::string doc, std::function<R(Args...)> function)
        : OperationBase(owner, std::move(name), std::move(doc)), function_(std::move(function)) {}

    R operator()(Args... arguments) {
        if constexpr (std::is_void_v<R>) {
            owner().activity().call([&] { function_(arguments...); });
        } else {
            std::optional<R> result;
            owner().activity().call([&] { result.emplace(function_(arguments...)); });
            return std::move(*result);
        }
    }

    std::string signature() const override {
        const std::vector<std::string> names{configTypeName<std::remove_cvref_t<Args>>()...};
        return fmt::format("{}({})", resultName(), fmt::join(names, ", "));
    }

    std::string callText(const std::vector<std::string>& texts) override {
        requireCount(texts, sizeof...(Args));
        Arguments arguments;
        ConfigReader reader("");
        parse(reader, texts, arguments, std::index_sequence_for<Args...>{});
        if (!reader.diagnostics().empty()) throw types::ConfigError(reader.diagnostics());
        if constexpr (std::is_void_v<R>)
            return std::apply(*this, arguments), "";
        else
            return configText(std::apply(*this, arguments));
    }

private:
    using Arguments = std::tuple<std::remove_cvref_t<Args>...>;

    static std::string resultName() {
        if constexpr (std::is_void_v<R>)
            return "void";
        else
            return configTypeName<R>();
    }
    template <size_t... I>
    void parse(ConfigReader& reader, const std::vector<std::string>& texts, Arguments& arguments,
               std::index_sequence<I...>) {
        (reader.readText(texts[I], fmt::format("{}[{}]", name(), I), std::get<I>(arguments)), ...);
    }

    std::function<R(Args...)> function_;
};

}  // namespace insonify::framework
