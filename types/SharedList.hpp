#pragma once
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace insonify::types {

/** A list whose copies share their items. Before an item is changed through one list, it is copied if another owner has
 *  it as well. Two lists with the same pointer at an index therefore have the same item. */
template <class T>
class SharedList {
    template <class List, class Item>
    class Iterator {
    public:
        using value_type = T;
        using difference_type = std::ptrdiff_t;
        using reference = Item&;
        using pointer = Item*;
        using iterator_category = std::forward_iterator_tag;

        Iterator() = default;
        Iterator(List* list, size_t index) : list_(list), index_(index) {}
        Item& operator*() const { return (*list_)[index_]; }
        Item* operator->() const { return &(*list_)[index_]; }
        Iterator& operator++() {
            ++index_;
            return *this;
        }
        Iterator operator++(int) { return {list_, index_++}; }
        friend difference_type operator-(const Iterator& a, const Iterator& b) {
            return static_cast<difference_type>(a.index_) - static_cast<difference_type>(b.index_);
        }
        friend bool operator==(const Iterator& a, const Iterator& b) { return a.index_ == b.index_; }

    private:
        List* list_ = nullptr;
        size_t index_ = 0;
    };

public:
    using Ptr = std::shared_ptr<const T>;
    using value_type = T;
    using iterator = Iterator<SharedList, T>;
    using const_iterator = Iterator<const SharedList, const T>;

    SharedList() = default;
    SharedList(std::vector<T> items) {  // NOLINT(google-explicit-constructor): a list of items is one
        items_.reserve(items.size());
        for (T& item : items) push_back(std::move(item));
    }
    SharedList(std::initializer_list<T> items) : SharedList(std::vector<T>(items)) {}

    size_t size() const { return items_.size(); }
    bool empty() const { return items_.empty(); }
    const T& operator[](size_t index) const { return *items_[index]; }
    const T& at(size_t index) const { return *items_.at(index); }
    const T& front() const { return *items_.front(); }
    const T& back() const { return *items_.back(); }
    const_iterator begin() const { return {this, 0}; }
    const_iterator end() const { return {this, size()}; }
    /** Returns an owner of the item, which may outlive the list. */
    const Ptr& shared(size_t index) const { return items_[index]; }
    /** Returns whether both lists have the same items, by their addresses. */
    bool sharesAll(const SharedList& other) const { return items_ == other.items_; }

    T& operator[](size_t index) { return own(items_[index]); }
    T& at(size_t index) { return own(items_.at(index)); }
    T& front() { return own(items_.front()); }
    T& back() { return own(items_.back()); }
    iterator begin() { return {this, 0}; }
    iterator end() { return {this, size()}; }
    void push_back(T item) { items_.push_back(std::make_shared<T>(std::move(item))); }
    void push_back(Ptr item) { items_.push_back(std::move(item)); }
    void replace(size_t index, Ptr item) { items_.at(index) = std::move(item); }
    template <class... Arguments>
    T& emplace_back(Arguments&&... arguments) {
        push_back(T{std::forward<Arguments>(arguments)...});
        return back();
    }
    void pop_back() { items_.pop_back(); }
    void clear() { items_.clear(); }
    void reserve(size_t count) { items_.reserve(count); }
    void resize(size_t count) {
        while (size() > count) pop_back();
        while (size() < count) emplace_back();
    }

private:
    static T& own(Ptr& item) {
        if (item.use_count() > 1) item = std::make_shared<T>(*item);
        return const_cast<T&>(*item);  // made by this class as a T that is not const, and nobody else has it
    }

    std::vector<Ptr> items_;
};

}  // namespace insonify::types
