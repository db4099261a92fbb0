#pragma once
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "components/framework/TaskContext.hpp"
#include "components/framework/config/ValueType.hpp"
#include "components/framework/execution/Activity.hpp"

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
    /** Calls with arguments in YAML and returns the result as text. Throws types::ConfigError when the arguments do not
     *  fit. */
    virtual std::string callText(const std::vector<std::string>& arguments) = 0;

protected:
    /** Throws types::ConfigError when the number of arguments is not `taken`. */
    void requireCount(const std::vector<std::string>& arguments, size_t taken) const;
    /** Returns "double(double, text)"; null `result`: no result. */
    static std::string makeSignature(const ValueType* result, const std::vector<const ValueType*>& arguments);
    /** Reads the arguments; their number is already checked. Throws types::ConfigError when an argument does not
     *  fit. */
    void read(const std::vector<std::string>& texts, const std::vector<const ValueType*>& types,
              const std::vector<void*>& values) const;

private:
    TaskContext* owner_;
    std::string name_, doc_;
};

template <class Signature>
class Operation;

/** A function of a task that others call. It runs on the task's own thread, in every state of the task.
 *
 *      framework::Operation<double(double)> turn{this, "turn", "turns the head to a bearing [rad]",
 *                                                [this](double bearing) { return head_.turn(bearing); }};
 *
 *  Exceptions reach the caller; the task's state stays. Argument types are those of properties. */
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
        if constexpr (std::is_void_v<R>)
            return makeSignature(nullptr, types());
        else
            return makeSignature(&getType<R>(), types());
    }

    std::string callText(const std::vector<std::string>& texts) override {
        requireCount(texts, sizeof...(Args));
        std::tuple<std::remove_cvref_t<Args>...> arguments;
        read(texts, types(), std::apply([](auto&... each) { return std::vector<void*>{&each...}; }, arguments));
        if constexpr (std::is_void_v<R>) {
            return std::apply(*this, arguments), "";
        } else {
            const R result = std::apply(*this, arguments);
            return getType<R>().text(&result);
        }
    }

private:
    static std::vector<const ValueType*> types() { return {&getType<std::remove_cvref_t<Args>>()...}; }

    std::function<R(Args...)> function_;
};

}  // namespace insonify::framework
