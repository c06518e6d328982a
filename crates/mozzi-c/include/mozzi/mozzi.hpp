// mozzi in C++17, header only: RAII over mozzi.h, calls on pointers, spans, containers and Eigen's vectors and matrices.
//
//   #include <mozzi/mozzi.hpp>
//
//   mozzi::Model arm = mozzi::Model::open("panda").value();   // throws mozzi::Exception; or ask the Result
//   mozzi::Workspace workspace(arm);                          // the memory of one thread
//   Eigen::VectorXd tau(arm.n());
//   workspace.inverse_dynamics(theta, dtheta, ddtheta, tau);  // noexcept, allocates nothing, returns a Status
//
// Setting up returns a Result: ask it (`if (!result) … result.status()`), or take `value()`, which throws; without
// exceptions it aborts. Calls in a loop return a Status: ask `ok()`, or `or_throw()`.
//
// Eigen is recognized by its members; this header never includes it. Its vectors, `Map`, `Ref` and blocks are used where
// they lie. Expressions such as `2 * q` have no place in memory: assign them first.
//
// See mozzi.h for lengths, units, threads and what may be called in real time.
#ifndef MOZZI_HPP
#define MOZZI_HPP

#if !(__cplusplus >= 201703L || (defined(_MSVC_LANG) && _MSVC_LANG >= 201703L))
#error "mozzi.hpp needs C++17: compile with -std=c++17 or newer"
#endif

#include "mozzi.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
#define MOZZI_HAS_EXCEPTIONS 1
#else
#define MOZZI_HAS_EXCEPTIONS 0
#endif

namespace mozzi {

/// A failure, thrown by `Result::value` and `Status::or_throw`.
class Exception : public std::runtime_error {
 public:
  Exception(mozzi_status code, const std::string &message) : std::runtime_error(message), code_(code) {}
  /// MOZZI_….
  mozzi_status code() const noexcept { return code_; }

 private:
  mozzi_status code_;
};

namespace detail {

[[noreturn]] inline void fail(mozzi_status code, const std::string &message) {
#if MOZZI_HAS_EXCEPTIONS
  throw Exception(code, message);
#else
  std::fprintf(stderr, "mozzi: %s (status %d)\n", message.c_str(), static_cast<int>(code));
  std::abort();
#endif
}

inline std::string text(const char *text) { return text == nullptr ? std::string() : std::string(text); }

constexpr std::size_t unknown = static_cast<std::size_t>(-1);
/// The size of a vector with gaps, such as a row of a matrix by columns.
constexpr std::size_t gaps = static_cast<std::size_t>(-2);

/// Has `data()` and `size()`: std::vector, std::array, std::span, …
template <class T, class Number, class = void>
struct IsRange : std::false_type {};
template <class T, class Number>
struct IsRange<T, Number,
               std::void_t<decltype(static_cast<Number *>(std::declval<T &>().data())),
                           decltype(static_cast<std::size_t>(std::declval<T &>().size()))>> : std::true_type {};

/// One of Eigen's types that lie in memory.
template <class T, class = void>
struct IsEigen : std::false_type {};
template <class T>
struct IsEigen<T, std::void_t<decltype(T::RowsAtCompileTime), decltype(T::IsRowMajor),
                              decltype(std::declval<T &>().innerStride()), decltype(std::declval<T &>().outerStride())>>
    : std::true_type {};

template <class T>
using Plain = std::remove_cv_t<std::remove_reference_t<T>>;

template <class T, class Number>
constexpr bool is_range = IsRange<std::remove_reference_t<T>, Number>::value && !IsEigen<Plain<T>>::value;
template <class T, class Number>
constexpr bool is_eigen = IsRange<std::remove_reference_t<T>, Number>::value && IsEigen<Plain<T>>::value;
template <class T>
constexpr bool is_pointer = std::is_same_v<Plain<T>, double *> || std::is_same_v<Plain<T>, const double *>;

inline bool fits(const char *name, std::size_t found, std::size_t expected) noexcept {
  if (found == unknown || found == expected) {
    return true;
  }
  found == gaps ? mozzi_report_gaps(name) : mozzi_report_length(name, found, expected);
  return false;
}

template <class T>
std::size_t vector_size(const T &x) noexcept {
  return x.size() <= 1 || x.innerStride() == 1 ? static_cast<std::size_t>(x.size()) : gaps;
}

}  // namespace detail

/// The outcome of a call.
class [[nodiscard]] Status {
 public:
  explicit Status(mozzi_status code) noexcept : code_(code) {}
  bool ok() const noexcept { return code_ == MOZZI_OK; }
  /// MOZZI_OK, MOZZI_NOT_FINITE, ….
  mozzi_status code() const noexcept { return code_; }
  /// A few words about the code.
  const char *text() const noexcept { return mozzi_status_text(code_); }
  /// The names and numbers of this thread's last failure, valid until the next.
  const char *message() const noexcept { return ok() ? "" : mozzi_last_error(); }
  /// Throws an Exception unless it is ok.
  void or_throw() const {
    if (!ok()) {
      detail::fail(code_, message());
    }
  }

 private:
  mozzi_status code_;
};

/// A value, or the reason why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  explicit Result(Status status) : status_(status), message_(status.message()) {}
  bool has_value() const noexcept { return value_.has_value(); }
  bool ok() const noexcept { return has_value(); }
  explicit operator bool() const noexcept { return has_value(); }
  Status status() const noexcept { return status_; }
  const std::string &message() const noexcept { return message_; }
  /// Throws an Exception if there is none.
  T &value() & {
    require();
    return *value_;
  }
  const T &value() const & {
    require();
    return *value_;
  }
  T &&value() && {
    require();
    return std::move(*value_);
  }
  T &operator*() & noexcept { return *value_; }
  T &&operator*() && noexcept { return std::move(*value_); }
  const T &operator*() const & noexcept { return *value_; }
  T *operator->() noexcept { return &*value_; }
  const T *operator->() const noexcept { return &*value_; }

 private:
  void require() const {
    if (!value_) {
      detail::fail(status_.code(), message_);
    }
  }

  std::optional<T> value_;
  Status status_{MOZZI_OK};
  std::string message_;
};

// ------------------------------------------------------------------------------------------------ arguments

/// Numbers to read: a pointer, an array, a container, a span, a vector of Eigen's.
class Input {
 public:
  Input(const double *data, std::size_t size) noexcept : data_(data), size_(size) {}
  /// Of the length that the call expects.
  template <class P, std::enable_if_t<detail::is_pointer<P>, int> = 0>
  Input(const P &data) noexcept : data_(data), size_(detail::unknown) {}
  template <std::size_t N>
  Input(const double (&array)[N]) noexcept : data_(array), size_(N) {}
  template <class T, std::enable_if_t<detail::is_range<const T, const double>, int> = 0>
  Input(const T &range) noexcept : data_(range.data()), size_(range.size()) {}
  template <class T, std::enable_if_t<detail::is_eigen<const T, const double>, int> = 0, class = void>
  Input(const T &vector) noexcept : data_(vector.data()), size_(detail::vector_size(vector)) {
    static_assert(T::IsVectorAtCompileTime, "expected a vector");
  }
  const double *data() const noexcept { return data_; }
  bool fits(const char *name, std::size_t expected) const noexcept { return detail::fits(name, size_, expected); }

 private:
  const double *data_;
  std::size_t size_;
};

/// Numbers to write, likewise.
class Vector {
 public:
  Vector(double *data, std::size_t size) noexcept : data_(data), size_(size) {}
  template <class P, std::enable_if_t<std::is_same_v<P, double *>, int> = 0>
  Vector(const P &data) noexcept : data_(data), size_(detail::unknown) {}
  template <std::size_t N>
  Vector(double (&array)[N]) noexcept : data_(array), size_(N) {}
  template <class T, std::enable_if_t<detail::is_range<T, double>, int> = 0>
  Vector(T &&range) noexcept : data_(range.data()), size_(range.size()) {}
  template <class T, std::enable_if_t<detail::is_eigen<T, double>, int> = 0, class = void>
  Vector(T &&vector) noexcept : data_(vector.data()), size_(detail::vector_size(vector)) {
    static_assert(detail::Plain<T>::IsVectorAtCompileTime, "expected a vector");
  }
  Vector(const Vector &) = default;
  Vector(Vector &) = default;
  Vector(Vector &&) = default;
  double *data() const noexcept { return data_; }
  bool fits(const char *name, std::size_t expected) const noexcept { return detail::fits(name, size_, expected); }

 private:
  double *data_;
  std::size_t size_;
};

/// A matrix to write: one of Eigen's, by columns or by rows, whole or a block; or numbers by rows.
class Matrix {
 public:
  /// Entry (i, j) at data[i * row_stride + j * column_stride].
  Matrix(double *data, std::size_t rows, std::size_t columns, std::ptrdiff_t row_stride,
         std::ptrdiff_t column_stride) noexcept
      : matrix_{data, row_stride, column_stride}, rows_(rows), columns_(columns), is_by_rows_(false) {}
  template <class P, std::enable_if_t<std::is_same_v<P, double *>, int> = 0>
  Matrix(const P &data) noexcept : matrix_{data, 0, 1}, size_(detail::unknown) {}
  template <std::size_t N>
  Matrix(double (&array)[N]) noexcept : matrix_{array, 0, 1}, size_(N) {}
  template <class T, std::enable_if_t<detail::is_range<T, double>, int> = 0>
  Matrix(T &&range) noexcept : matrix_{range.data(), 0, 1}, size_(range.size()) {}
  template <class T, std::enable_if_t<detail::is_eigen<T, double>, int> = 0, class = void>
  Matrix(T &&matrix) noexcept
      : matrix_{matrix.data(),
                static_cast<std::ptrdiff_t>(detail::Plain<T>::IsRowMajor ? matrix.outerStride() : matrix.innerStride()),
                static_cast<std::ptrdiff_t>(detail::Plain<T>::IsRowMajor ? matrix.innerStride() : matrix.outerStride())},
        rows_(static_cast<std::size_t>(matrix.rows())),
        columns_(static_cast<std::size_t>(matrix.cols())),
        is_by_rows_(false) {}
  Matrix(const Matrix &) = default;
  Matrix(Matrix &) = default;
  Matrix(Matrix &&) = default;
  mozzi_matrix c() const noexcept { return matrix_; }
  bool fits(const char *name, std::size_t rows, std::size_t columns) noexcept {
    if (is_by_rows_) {
      matrix_.row_stride = static_cast<std::ptrdiff_t>(columns);
      return detail::fits(name, size_, rows * columns);
    }
    return detail::fits(name, rows_, rows) && detail::fits(name, columns_, columns);
  }

 private:
  mozzi_matrix matrix_;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  std::size_t size_ = 0;
  bool is_by_rows_ = true;
};

/// A list of matrices to write: numbers by rows, or with strides.
class Tensor {
 public:
  explicit Tensor(mozzi_tensor tensor) noexcept : tensor_(tensor), is_by_rows_(false) {}
  template <class P, std::enable_if_t<std::is_same_v<P, double *>, int> = 0>
  Tensor(const P &data) noexcept : tensor_{data, 0, 0, 1}, size_(detail::unknown) {}
  template <class T, std::enable_if_t<detail::is_range<T, double>, int> = 0>
  Tensor(T &&range) noexcept : tensor_{range.data(), 0, 0, 1}, size_(range.size()) {}
  Tensor(const Tensor &) = default;
  Tensor(Tensor &) = default;
  Tensor(Tensor &&) = default;
  mozzi_tensor c() const noexcept { return tensor_; }
  bool fits(const char *name, std::size_t blocks, std::size_t rows, std::size_t columns) noexcept {
    if (!is_by_rows_) {
      return true;
    }
    tensor_.block_stride = static_cast<std::ptrdiff_t>(rows * columns);
    tensor_.row_stride = static_cast<std::ptrdiff_t>(columns);
    return detail::fits(name, size_, blocks * rows * columns);
  }

 private:
  mozzi_tensor tensor_;
  std::size_t size_ = 0;
  bool is_by_rows_ = true;
};

/// A configuration to read, 4 × 4: numbers by rows, or a matrix of Eigen's.
class Pose {
 public:
  template <class T, std::enable_if_t<!detail::is_eigen<const T, const double>, int> = 0>
  Pose(const T &by_rows) noexcept {
    Input numbers(by_rows);
    has_size_ = numbers.fits("the configuration", 16);
    is_given_ = has_size_ && numbers.data() != nullptr;
    if (is_given_) {
      std::copy(numbers.data(), numbers.data() + 16, numbers_.begin());
    }
  }
  template <class T, std::enable_if_t<detail::is_eigen<const T, const double>, int> = 0, class = void>
  Pose(const T &matrix) noexcept {
    has_size_ = detail::fits("the configuration's rows", static_cast<std::size_t>(matrix.rows()), 4) &&
                detail::fits("the configuration's columns", static_cast<std::size_t>(matrix.cols()), 4);
    is_given_ = has_size_;
    if (has_size_) {
      for (int k = 0; k < 16; ++k) {
        numbers_[static_cast<std::size_t>(k)] = matrix(k / 4, k % 4);
      }
    }
  }
  /// 16 numbers by rows; null if it was null.
  const double *data() const noexcept { return is_given_ ? numbers_.data() : nullptr; }
  /// Whether it had another size.
  Status status() const noexcept { return Status(has_size_ ? MOZZI_OK : MOZZI_WRONG_LENGTH); }

 private:
  std::array<double, 16> numbers_{};
  bool has_size_ = false, is_given_ = false;
};

/// A named frame of one model.
class Frame {
 public:
  Frame() = default;
  explicit Frame(mozzi_frame frame) noexcept : frame_(frame) {}
  mozzi_frame c() const noexcept { return frame_; }
  /// From 0: its place in `frame_poses`.
  std::size_t number() const noexcept { return static_cast<std::size_t>(frame_ & 0xffffffffu); }

 private:
  mozzi_frame frame_ = 0;
};

/// The coordinates of a task.
enum class Coordinates : std::int32_t { body = MOZZI_BODY, space = MOZZI_SPACE };

/// Rows of a frame's twist (ω_x, ω_y, ω_z, v_x, v_y, v_z): numbers from 0 to 5; none for all six.
class Task {
 public:
  explicit Task(Frame frame, Coordinates coordinates = Coordinates::body,
                std::initializer_list<std::size_t> rows = {}) noexcept
      : task_{frame.c(), static_cast<std::int32_t>(coordinates), nullptr, rows.size()} {
    std::size_t k = 0;
    for (std::size_t row : rows) {
      if (k < rows_.size()) {
        rows_[k++] = row;
      }
    }
  }
  const mozzi_task &c() const noexcept {
    task_.rows = rows_.data();
    return task_;
  }
  std::size_t rows() const noexcept { return task_.row_count == 0 ? 6 : task_.row_count; }

 private:
  std::array<std::size_t, 6> rows_{};
  mutable mozzi_task task_;
};

/// A point of {s}, m.
class Point {
 public:
  Point() = default;
  Point(double x, double y, double z) noexcept : point_{x, y, z} {}
  const double *c() const noexcept { return point_.data(); }

 private:
  std::array<double, 3> point_{};
};

/// What surrounds the robot; `Model::environment` gives the model's own. Change `gravity`, `base_twist` and
/// `base_acceleration` as they are in mozzi.h, and wrenches by `apply`.
class Environment : public mozzi_environment {
 public:
  Environment(const Environment &other) : mozzi_environment(other), applied_(other.applied_) { refer(); }
  Environment(Environment &&other) noexcept : mozzi_environment(other), applied_(std::move(other.applied_)) {
    refer();
    other.refer();
  }
  Environment &operator=(Environment other) noexcept {
    static_cast<mozzi_environment &>(*this) = other;
    applied_.swap(other.applied_);
    refer();
    return *this;
  }
  /// Makes room for wrenches of this many frames, so that `apply` allocates nothing.
  void reserve(std::size_t frames) {
    applied_.reserve(frames);
    refer();
  }
  /// The frame's wrench (m, f) on the environment, in its own coordinates; replaces an earlier one.
  void apply(Frame frame, const std::array<double, 6> &F) {
    std::size_t k = 0;
    while (k < applied_.size() && applied_[k].frame != frame.c()) {
      ++k;
    }
    if (k == applied_.size()) {
      applied_.push_back(mozzi_wrench{frame.c(), {}});
    }
    std::copy(F.begin(), F.end(), applied_[k].F);
    refer();
  }

 private:
  friend class Model;
  Environment() : mozzi_environment{} {}
  void refer() noexcept {
    wrenches = applied_.data();
    wrench_count = applied_.size();
  }

  std::vector<mozzi_wrench> applied_;
};

/// An environment as an argument; without one, the model's own.
class Around {
 public:
  Around() = default;
  Around(const Environment &environment) noexcept : environment_(&environment) {}
  const mozzi_environment *c() const noexcept { return environment_; }

 private:
  const mozzi_environment *environment_ = nullptr;
};

// -------------------------------------------------------------------------------------------------- handles

namespace detail {

/// Owns a handle of C.
template <class T, mozzi_status (*release)(T *)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(T *handle) noexcept : handle_(handle) {}
  Handle(Handle &&other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Handle &operator=(Handle &&other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  Handle(const Handle &) = delete;
  Handle &operator=(const Handle &) = delete;
  ~Handle() { release(handle_); }
  T *get() const noexcept { return handle_; }
  T **put() noexcept { return &handle_; }

 private:
  T *handle_ = nullptr;
};

}  // namespace detail

/// A finding in a robot's file.
struct Diagnostic {
  bool is_error;
  /// MOZZI_CONSEQUENCE_….
  std::int32_t consequence;
  std::string code, message, file;
  std::size_t line, column;
  std::string calls, help, text;
};

/// How to read a robot.
struct LoadOptions {
  /// MOZZI_POLICY_….
  std::int32_t policy = MOZZI_POLICY_DEFAULT;
  bool floating = false;
  std::vector<std::pair<std::string, std::string>> xacro_arguments;
  /// Names and folders.
  std::vector<std::pair<std::string, std::string>> packages;
};

/// Limits of the independent joints, ± infinity where there is none.
struct Limits {
  std::vector<double> lower, upper, velocity, effort;
};

/// A state of the robot.
struct State {
  double time = 0;
  std::vector<double> theta, dtheta;
};

/// A robot: constants alone, shared by all threads and cheap to copy.
class Model {
 public:
  /// A file, or else the embedded robot of this name; `diagnostics` receives what is wrong or odd, of a refused file, too.
  static Result<Model> open(const std::string &name_or_path, const LoadOptions &options = {},
                            std::vector<Diagnostic> *diagnostics = nullptr) {
    return read(options, diagnostics, [&](auto *o, auto **m, auto **d) {
      return mozzi_model_open(name_or_path.c_str(), o, m, d);
    });
  }
  /// A file.
  static Result<Model> load(const std::string &path, const LoadOptions &options = {},
                            std::vector<Diagnostic> *diagnostics = nullptr) {
    return read(options, diagnostics, [&](auto *o, auto **m, auto **d) {
      return mozzi_model_load(path.c_str(), o, m, d);
    });
  }
  /// A text of URDF, xacro or MJCF, by this name in diagnostics.
  static Result<Model> parse(const std::string &name, std::string_view text, const LoadOptions &options = {},
                             std::vector<Diagnostic> *diagnostics = nullptr) {
    return read(options, diagnostics, [&](auto *o, auto **m, auto **d) {
      return mozzi_model_parse(name.c_str(), text.data(), text.size(), o, m, d);
    });
  }
  /// One of the embedded robots.
  static Result<Model> embedded(const std::string &name) {
    return made([&](mozzi_model **m) { return mozzi_model_embedded(name.c_str(), m); });
  }

  /// Another handle of a model of C's.
  static Model from(const mozzi_model *model) {
    Model copy;
    mozzi_model_copy(model, copy.handle_.put());
    return copy;
  }

  Model(const Model &other) { mozzi_model_copy(other.get(), handle_.put()); }
  Model &operator=(const Model &other) { return *this = Model(other); }
  Model(Model &&) = default;
  Model &operator=(Model &&) = default;

  const mozzi_model *get() const noexcept { return handle_.get(); }
  std::size_t n() const noexcept { return mozzi_model_n(get()); }
  std::size_t nq() const noexcept { return mozzi_model_nq(get()); }
  std::size_t parameter_count() const noexcept { return mozzi_model_parameter_count(get()); }
  std::size_t body_count() const noexcept { return mozzi_model_body_count(get()); }
  std::size_t constraint_rows() const noexcept { return mozzi_model_constraint_rows(get()); }
  std::size_t joint_count() const noexcept { return mozzi_model_joint_count(get()); }
  std::size_t frame_count() const noexcept { return mozzi_model_frame_count(get()); }
  bool is_floating() const noexcept { return mozzi_model_is_floating(get()) != 0; }
  double mass() const noexcept { return mozzi_model_mass(get()); }
  std::string name() const { return detail::text(mozzi_model_name(get())); }
  std::vector<std::string> joint_names() const { return names(mozzi_model_joint_name, joint_count()); }
  std::vector<std::string> position_names() const { return names(mozzi_model_position_name, nq()); }
  std::vector<std::string> velocity_names() const { return names(mozzi_model_velocity_name, n()); }
  std::vector<std::string> frame_names() const { return names(mozzi_model_frame_name, frame_count()); }
  std::vector<std::string> parameter_names() const { return names(mozzi_model_parameter_name, parameter_count()); }
  std::vector<std::string> constraint_row_names() const {
    return names(mozzi_model_constraint_row_name, constraint_rows());
  }
  std::vector<std::string> state_names() const {
    return names(mozzi_model_state_name, mozzi_model_state_count(get()));
  }
  std::vector<double> parameters() const {
    std::vector<double> parameters(parameter_count());
    mozzi_model_parameters(get(), parameters.data());
    return parameters;
  }
  std::array<double, 3> gravity() const noexcept {
    std::array<double, 3> gravity{};
    mozzi_model_gravity(get(), gravity.data());
    return gravity;
  }
  Limits limits() const {
    std::vector<double> none(joint_count());
    Limits limits{none, none, none, none};
    mozzi_model_limits(get(), limits.lower.data(), limits.upper.data(), limits.velocity.data(), limits.effort.data());
    return limits;
  }
  /// The state in which the robot starts.
  State start() const {
    State state{0, std::vector<double>(nq()), std::vector<double>(n())};
    mozzi_model_start(get(), state.theta.data(), state.dtheta.data(), &state.time);
    return state;
  }
  Result<State> state(const std::string &name) const {
    State state{0, std::vector<double>(nq()), std::vector<double>(n())};
    Status status(mozzi_model_state(get(), name.c_str(), state.theta.data(), state.dtheta.data(), &state.time));
    return status.ok() ? Result<State>(std::move(state)) : Result<State>(status);
  }
  /// Its gravity, {s} at rest, no wrenches; with room for a wrench on each frame.
  Environment environment() const {
    Environment environment;
    mozzi_model_environment(get(), &environment);
    environment.reserve(frame_count());
    return environment;
  }

  Result<Frame> frame(const std::string &name) const {
    return found([&](mozzi_frame *f) { return mozzi_model_frame(get(), name.c_str(), f); });
  }
  Result<Frame> end_effector() const {
    return found([&](mozzi_frame *f) { return mozzi_model_end_effector(get(), f); });
  }

  /// θ ← θ ⊕ θ̇h.
  Status integrate(Vector theta, Input dtheta, double h) const noexcept {
    if (!(theta.fits("theta", nq()) && dtheta.fits("dtheta", n()))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_integrate(get(), theta.data(), dtheta.data(), h));
  }
  /// θ₁ ⊖ θ₀.
  Status difference(Input theta0, Input theta1, Vector difference) const noexcept {
    if (!(theta0.fits("theta0", nq()) && theta1.fits("theta1", nq()) && difference.fits("difference", n()))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_difference(get(), theta0.data(), theta1.data(), difference.data()));
  }

  /// With a payload: (m, m c, I about the frame's origin), ten numbers in the frame's coordinates.
  Result<Model> with_payload(Frame frame, const std::array<double, 10> &parameters) const {
    return made([&](auto **m) { return mozzi_model_with_payload(get(), frame.c(), parameters.data(), m); });
  }
  Result<Model> with_locked_joints(const std::vector<std::pair<std::string, double>> &positions) const {
    std::vector<const char *> joints;
    std::vector<double> values;
    for (const auto &[joint, position] : positions) {
      joints.push_back(joint.c_str());
      values.push_back(position);
    }
    return made([&](auto **m) {
      return mozzi_model_with_locked_joints(get(), joints.data(), values.data(), joints.size(), m);
    });
  }
  Result<Model> with_frame(const std::string &name, Frame on, const Pose &T) const {
    if (!T.status().ok()) {
      return Result<Model>(T.status());
    }
    return made([&](auto **m) { return mozzi_model_with_frame(get(), name.c_str(), on.c(), T.data(), m); });
  }
  Result<Model> with_end_effector(Frame frame) const {
    return made([&](auto **m) { return mozzi_model_with_end_effector(get(), frame.c(), m); });
  }
  Result<Model> with_gravity(const std::array<double, 3> &gravity) const {
    return made([&](auto **m) { return mozzi_model_with_gravity(get(), gravity.data(), m); });
  }
  Result<Model> with_base(bool floating) const {
    return made([&](auto **m) { return mozzi_model_with_base(get(), floating ? 1 : 0, m); });
  }
  Result<Model> sub_chain(Frame from, Frame to) const {
    return made([&](auto **m) { return mozzi_model_sub_chain(get(), from.c(), to.c(), m); });
  }
  Result<Model> with_parameters(Input parameters) const {
    if (!parameters.fits("parameters", parameter_count())) {
      return Result<Model>(Status(MOZZI_WRONG_LENGTH));
    }
    return made([&](auto **m) { return mozzi_model_with_parameters(get(), parameters.data(), m); });
  }
  /// With the constraints of a text in JSON or YAML.
  Result<Model> with_constraints(const std::string &constraints) const {
    return made([&](auto **m) { return mozzi_model_with_constraints(get(), constraints.c_str(), m); });
  }
  Result<Model> without_constraints() const {
    return made([&](auto **m) { return mozzi_model_without_constraints(get(), m); });
  }
  Result<Model> with_state(const std::string &name, Input theta, Input dtheta, double time = 0) const {
    if (!(theta.fits("theta", nq()) && dtheta.fits("dtheta", n()))) {
      return Result<Model>(Status(MOZZI_WRONG_LENGTH));
    }
    return made(
        [&](auto **m) { return mozzi_model_with_state(get(), name.c_str(), theta.data(), dtheta.data(), time, m); });
  }
  Result<Model> with_start(const std::string &name) const {
    return made([&](auto **m) { return mozzi_model_with_start(get(), name.c_str(), m); });
  }
  /// Positions near a guess that satisfy the constraints; the joints of `hold` keep theirs.
  Status assemble(Input guess, Vector theta, const std::vector<std::string> &hold = {}) const {
    if (!(guess.fits("guess", nq()) && theta.fits("theta", nq()))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    std::vector<const char *> held;
    for (const std::string &joint : hold) {
      held.push_back(joint.c_str());
    }
    return Status(mozzi_assemble(get(), guess.data(), held.data(), held.size(), theta.data()));
  }

 private:
  Model() = default;

  template <class F>
  static Result<Model> made(F make) {
    Model model;
    Status status(make(model.handle_.put()));
    return status.ok() ? Result<Model>(std::move(model)) : Result<Model>(status);
  }
  template <class F>
  static Result<Frame> found(F find) {
    mozzi_frame frame = 0;
    Status status(find(&frame));
    return status.ok() ? Result<Frame>(Frame(frame)) : Result<Frame>(status);
  }
  template <class F>
  static Result<Model> read(const LoadOptions &options, std::vector<Diagnostic> *findings, F load) {
    std::vector<mozzi_pair> values, packages;
    for (const auto &[name, value] : options.xacro_arguments) {
      values.push_back({name.c_str(), value.c_str()});
    }
    for (const auto &[name, folder] : options.packages) {
      packages.push_back({name.c_str(), folder.c_str()});
    }
    const mozzi_load_options c{options.policy, options.floating ? 1 : 0, values.data(),
                               values.size(),  packages.data(),          packages.size()};
    detail::Handle<mozzi_diagnostics, mozzi_diagnostics_free> diagnostics;
    Result<Model> result = made([&](auto **m) { return load(&c, m, diagnostics.put()); });
    for (std::size_t k = 0; findings != nullptr && k < mozzi_diagnostics_count(diagnostics.get()); ++k) {
      mozzi_diagnostic d{};
      if (mozzi_diagnostics_get(diagnostics.get(), k, &d) == MOZZI_OK) {
        findings->push_back({d.is_error != 0, d.consequence, detail::text(d.code), detail::text(d.message),
                             detail::text(d.file), d.line, d.column, detail::text(d.calls), detail::text(d.help),
                             detail::text(d.text)});
      }
    }
    return result;
  }
  template <class F>
  std::vector<std::string> names(F name_of, std::size_t count) const {
    std::vector<std::string> list;
    for (std::size_t k = 0; k < count; ++k) {
      list.push_back(detail::text(name_of(get(), k)));
    }
    return list;
  }

  detail::Handle<mozzi_model, mozzi_model_free> handle_;
};

/// A quantity for a program: its number, MOZZI_INVERSE_DYNAMICS or another, and its frame, task or point.
struct Quantity {
  Quantity(std::int32_t quantity) noexcept : number(quantity) {}
  Quantity(std::int32_t quantity, Frame frame) noexcept : number(quantity) { subject.task.frame = frame.c(); }
  Quantity(std::int32_t quantity, const Task &of) noexcept : number(quantity), task(of) {}
  std::int32_t number;
  mozzi_subject subject{};
  std::optional<Task> task;
  mozzi_subject c() const noexcept {
    mozzi_subject c = subject;
    if (task) {
      c.task = task->c();
    }
    return c;
  }
};

/// Quantities of a robot as machine code.
class Program {
 public:
  static Result<Program> compile(const Model &model, const std::vector<Quantity> &quantities) {
    std::vector<std::int32_t> numbers;
    std::vector<mozzi_subject> subjects;
    for (const Quantity &quantity : quantities) {
      numbers.push_back(quantity.number);
      subjects.push_back(quantity.c());
    }
    Program program(model);
    Status status(
        mozzi_program_new(model.get(), numbers.data(), subjects.data(), numbers.size(), program.handle_.put()));
    return status.ok() ? Result<Program>(std::move(program)) : Result<Program>(status);
  }
  /// Is there machine code for this quantity?
  bool has_code(const Quantity &quantity) const noexcept {
    const mozzi_subject subject = quantity.c();
    return mozzi_program_has_code(get(), quantity.number, &subject) != 0;
  }
  const mozzi_program *get() const noexcept { return handle_.get(); }
  const Model &model() const noexcept { return model_; }

 private:
  explicit Program(const Model &model) : model_(model) {}

  Model model_;
  detail::Handle<mozzi_program, mozzi_program_free> handle_;
};

/// The memory of one thread, and the quantities at one state. A method returns a Status, allocates nothing and does not
/// throw. Shapes are in parentheses: n velocities, nq positions, p parameters, b bodies, k rows of a task, m rows of the
/// constraints; units are those of revolute joints, then of prismatic ones.
class Workspace {
 public:
  /// Throws an Exception if it fails, as a model that was moved away does.
  explicit Workspace(const Model &model) : Workspace(create(model).value()) {}
  /// With machine code in the robot's own environment.
  explicit Workspace(const Program &program) : Workspace(create(program).value()) {}
  static Result<Workspace> create(const Model &model) {
    return created(model, [&](auto **w) { return mozzi_workspace_new(model.get(), w); });
  }
  static Result<Workspace> create(const Program &program) {
    return created(program.model(), [&](auto **w) { return mozzi_workspace_with_program(program.get(), w); });
  }
  mozzi_workspace *get() const noexcept { return handle_.get(); }
  const Model &model() const noexcept { return model_; }

  // The quantities: from here on written by `cargo xtask docs`.

  /// τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ, θ̇), the joint forces of a motion.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². Gives tau (n), N m or N.
  Status inverse_dynamics(Input theta, Input dtheta, Input ddtheta, Vector tau,
      Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          tau.fits("tau", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_inverse_dynamics(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(),
        environment.c(), tau.data()));
  }

  /// θ̈ = M⁻¹(τ − c − g − JᵀF − f), the accelerations that joint forces produce.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. Gives ddtheta (n), rad/s² or m/s².
  Status forward_dynamics(Input theta, Input dtheta, Input tau, Vector ddtheta,
      Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && tau.fits("tau", sizes_.n) &&
          ddtheta.fits("ddtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_forward_dynamics(model_.get(), get(), theta.data(), dtheta.data(), tau.data(), environment.c(),
        ddtheta.data()));
  }

  /// θ̈ = M⁻¹(τ − c − g − JᵀF − f), by composite bodies and the factors of M along the tree.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. Gives ddtheta (n), rad/s² or m/s².
  Status forward_dynamics_by_mass_matrix(Input theta, Input dtheta, Input tau, Vector ddtheta,
      Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && tau.fits("tau", sizes_.n) &&
          ddtheta.fits("ddtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_forward_dynamics_by_mass_matrix(model_.get(), get(), theta.data(), dtheta.data(), tau.data(),
        environment.c(), ddtheta.data()));
  }

  /// θ̈ = M⁻¹(τ − c − g − JᵀF − f), M and h by calls of inverse dynamics.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. Gives ddtheta (n), rad/s² or m/s².
  Status forward_dynamics_by_inverse_dynamics(Input theta, Input dtheta, Input tau, Vector ddtheta,
      Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && tau.fits("tau", sizes_.n) &&
          ddtheta.fits("ddtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_forward_dynamics_by_inverse_dynamics(model_.get(), get(), theta.data(), dtheta.data(),
        tau.data(), environment.c(), ddtheta.data()));
  }

  /// M(θ), symmetric, with the rotors' inertia on its diagonal.
  /// theta (nq), rad or m. Gives M (n × n), kg m², kg m or kg.
  Status mass_matrix(Input theta, Matrix M) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && M.fits("M", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_mass_matrix(model_.get(), get(), theta.data(), M.c()));
  }

  /// M(θ)⁻¹, the accelerations that a unit of each joint force produces.
  /// theta (nq), rad or m. Gives inverse (n × n), 1/(kg m²), 1/(kg m) or 1/kg.
  Status mass_matrix_inverse(Input theta, Matrix inverse) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && inverse.fits("inverse", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_mass_matrix_inverse(model_.get(), get(), theta.data(), inverse.c()));
  }

  /// Ṁ(θ, θ̇) = C + Cᵀ.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives dM (n × n), kg m²/s, kg m/s or kg/s.
  Status mass_matrix_rate(Input theta, Input dtheta, Matrix dM) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && dM.fits("dM", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_mass_matrix_rate(model_.get(), get(), theta.data(), dtheta.data(), dM.c()));
  }

  /// C(θ, θ̇) of the Christoffel symbols: c = Cθ̇, and Ṁ − 2C is skew-symmetric.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives C (n × n), N m s, N s or N s/m.
  Status coriolis_matrix(Input theta, Input dtheta, Matrix C) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && C.fits("C", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_coriolis_matrix(model_.get(), get(), theta.data(), dtheta.data(), C.c()));
  }

  /// c(θ, θ̇) = Cθ̇, the Coriolis and centripetal forces.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives c (n), N m or N.
  Status velocity_product(Input theta, Input dtheta, Vector c) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && c.fits("c", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_velocity_product(model_.get(), get(), theta.data(), dtheta.data(), c.data()));
  }

  /// g(θ), the joint forces that hold the robot against gravity.
  /// theta (nq), rad or m. Gives g (n), N m or N.
  Status gravity_forces(Input theta, Vector g, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && g.fits("g", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_gravity_forces(model_.get(), get(), theta.data(), environment.c(), g.data()));
  }

  /// h(θ, θ̇) = c + g, with JᵀF and the base's terms where they are given; without friction and springs.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives h (n), N m or N.
  Status bias_forces(Input theta, Input dtheta, Vector h, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && h.fits("h", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_bias_forces(model_.get(), get(), theta.data(), dtheta.data(), environment.c(), h.data()));
  }

  /// JᵀF of the wrenches that frames apply to the environment.
  /// theta (nq), rad or m. Gives tau (n), N m or N.
  Status tip_forces(Input theta, Vector tau, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && tau.fits("tau", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_tip_forces(model_.get(), get(), theta.data(), environment.c(), tau.data()));
  }

  /// f(θ̇) = dθ̇ + μ sgn θ̇ of each joint, with sgn 0 = 0.
  /// dtheta (n), rad/s or m/s. Gives f (n), N m or N.
  Status joint_friction(Input dtheta, Vector f) noexcept {
    if (!(dtheta.fits("dtheta", sizes_.n) && f.fits("f", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_joint_friction(model_.get(), get(), dtheta.data(), f.data()));
  }

  /// f_s(θ) = k(θ − θ₀) of each joint, θ not wrapped; kφ of a ball, φ its rotation vector.
  /// theta (nq), rad or m. Gives f (n), N m or N.
  Status spring_forces(Input theta, Vector f) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && f.fits("f", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_spring_forces(model_.get(), get(), theta.data(), f.data()));
  }

  /// ½θ̇ᵀMθ̇, of all that moves.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives energy, J.
  Status kinetic_energy(Input theta, Input dtheta, double &energy, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_kinetic_energy(model_.get(), get(), theta.data(), dtheta.data(), environment.c(), &energy));
  }

  /// −Σ m gᵀp + Σ ½k(θ − θ₀)², p seen from the origin of {s}.
  /// theta (nq), rad or m. Gives energy, J.
  Status potential_energy(Input theta, double &energy, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_potential_energy(model_.get(), get(), theta.data(), environment.c(), &energy));
  }

  /// T_sb(θ), the configuration of a frame {b} seen from {s}.
  /// theta (nq), rad or m. Gives T (4 × 4), m.
  Status forward_kinematics(Input theta, Frame frame, Matrix T) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && T.fits("T", 4, 4))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_forward_kinematics(model_.get(), get(), theta.data(), frame.c(), T.c()));
  }

  /// T_sb(θ) of all frames, in the order of the model's list.
  /// theta (nq), rad or m. Gives T (frames × 4 × 4), m.
  Status frame_poses(Input theta, Tensor T) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && T.fits("T", sizes_.frames, 4, 4))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_frame_poses(model_.get(), get(), theta.data(), T.c()));
  }

  /// J_s(θ) of a frame: its twist in {s} is J_sθ̇, (ω, v).
  /// theta (nq), rad or m. Gives J (6 × n), 1 or m.
  Status space_jacobian(Input theta, Frame frame, Matrix J) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && J.fits("J", 6, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_space_jacobian(model_.get(), get(), theta.data(), frame.c(), J.c()));
  }

  /// J_b(θ) of a frame: its twist in its own coordinates is J_bθ̇, (ω, v).
  /// theta (nq), rad or m. Gives J (6 × n), 1 or m.
  Status body_jacobian(Input theta, Frame frame, Matrix J) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && J.fits("J", 6, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_body_jacobian(model_.get(), get(), theta.data(), frame.c(), J.c()));
  }

  /// dJ_s/dt of a frame.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives dJ (6 × n), 1/s or m/s.
  Status space_jacobian_rate(Input theta, Input dtheta, Frame frame, Matrix dJ) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && dJ.fits("dJ", 6, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_space_jacobian_rate(model_.get(), get(), theta.data(), dtheta.data(), frame.c(), dJ.c()));
  }

  /// dJ_b/dt of a frame.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives dJ (6 × n), 1/s or m/s.
  Status body_jacobian_rate(Input theta, Input dtheta, Frame frame, Matrix dJ) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && dJ.fits("dJ", 6, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_body_jacobian_rate(model_.get(), get(), theta.data(), dtheta.data(), frame.c(), dJ.c()));
  }

  /// ∂J_s/∂θ_j of a frame for each velocity j.
  /// theta (nq), rad or m. Gives H (n × 6 × n), 1 or m, each per unit of θ_j.
  Status space_jacobian_derivative(Input theta, Frame frame, Tensor H) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && H.fits("H", sizes_.n, 6, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_space_jacobian_derivative(model_.get(), get(), theta.data(), frame.c(), H.c()));
  }

  /// ∂J_b/∂θ_j of a frame for each velocity j.
  /// theta (nq), rad or m. Gives H (n × 6 × n), 1 or m, each per unit of θ_j.
  Status body_jacobian_derivative(Input theta, Frame frame, Tensor H) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && H.fits("H", sizes_.n, 6, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_body_jacobian_derivative(model_.get(), get(), theta.data(), frame.c(), H.c()));
  }

  /// the classical acceleration of a frame, angular and of its origin, in its own coordinates.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². Gives a (6), rad/s², m/s².
  Status frame_acceleration(Input theta, Input dtheta, Input ddtheta, Frame frame, Vector a) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          a.fits("a", 6))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_frame_acceleration(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(), frame.c(),
        a.data()));
  }

  /// Λ and η of 𝓕 = Λ(θ)𝒱̇ + η(θ, 𝒱), the dynamics as the rows of a frame's twist show them.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives Lambda (k × k), kg m², kg m, kg; eta (k), N m, N.
  Status task_space_dynamics(Input theta, Input dtheta, const Task &task, Matrix Lambda, Vector eta,
      Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && Lambda.fits("Lambda", task.rows(),
          task.rows()) && eta.fits("eta", task.rows()))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_task_space_dynamics(model_.get(), get(), theta.data(), dtheta.data(), &task.c(),
        environment.c(), Lambda.c(), eta.data()));
  }

  /// θ̈ and λ of τ = Mθ̈ + c + g + JᵀF + f + Aᵀλ with Aθ̈ + Ȧθ̇ = 0.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. Gives ddtheta (n), rad/s² or m/s²; multipliers
  /// (m), N m or N.
  Status constrained_forward_dynamics(Input theta, Input dtheta, Input tau, Vector ddtheta, Vector multipliers,
      Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && tau.fits("tau", sizes_.n) &&
          ddtheta.fits("ddtheta", sizes_.n) && multipliers.fits("multipliers", sizes_.constraints))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_constrained_forward_dynamics(model_.get(), get(), theta.data(), dtheta.data(), tau.data(),
        environment.c(), ddtheta.data(), multipliers.data()));
  }

  /// A(θ) of the constraints A(θ)θ̇ = 0.
  /// theta (nq), rad or m. Gives A (m × n), 1 or m.
  Status constraint_jacobian(Input theta, Matrix A) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && A.fits("A", sizes_.constraints, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_constraint_jacobian(model_.get(), get(), theta.data(), A.c()));
  }

  /// Ȧ(θ, θ̇)θ̇ of the constraints: Aθ̈ + Ȧθ̇ = 0.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives dA_dtheta (m), rad/s² or m/s².
  Status constraint_bias(Input theta, Input dtheta, Vector dA_dtheta) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && dA_dtheta.fits("dA_dtheta",
          sizes_.constraints))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_constraint_bias(model_.get(), get(), theta.data(), dtheta.data(), dA_dtheta.data()));
  }

  /// φ(θ), by how much the positions violate the constraints.
  /// theta (nq), rad or m. Gives phi (m), rad or m.
  Status constraint_residual(Input theta, Vector phi) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && phi.fits("phi", sizes_.constraints))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_constraint_residual(model_.get(), get(), theta.data(), phi.data()));
  }

  /// P(θ) = 1 − Aᵀ(A M⁻¹Aᵀ)⁻¹A M⁻¹: Pτ = P(Mθ̈ + h).
  /// theta (nq), rad or m. Gives P (n × n), 1, m or 1/m.
  Status constraint_projection(Input theta, Matrix P) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && P.fits("P", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_constraint_projection(model_.get(), get(), theta.data(), P.c()));
  }

  /// θ̇⁺ and Λ of M(θ̇⁺ − θ̇) = −AᵀΛ with Aθ̇⁺ = 0: the velocities after the constraints have begun to act.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives dtheta_after (n), rad/s or m/s; impulse (m), N m s or N s.
  Status constraint_impulse(Input theta, Input dtheta, Vector dtheta_after, Vector impulse) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && dtheta_after.fits("dtheta_after",
          sizes_.n) && impulse.fits("impulse", sizes_.constraints))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_constraint_impulse(model_.get(), get(), theta.data(), dtheta.data(), dtheta_after.data(),
        impulse.data()));
  }

  /// ∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M, row i of τ_i; by θ along the velocities.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². Gives d_theta (n × n), N m or N,
  /// each per unit of its column; d_dtheta (n × n), N m or N, each per unit of its column; d_ddtheta (n × n), N m or
  /// N, each per unit of its column.
  Status inverse_dynamics_derivatives(Input theta, Input dtheta, Input ddtheta, Matrix d_theta, Matrix d_dtheta,
      Matrix d_ddtheta, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          d_theta.fits("d_theta", sizes_.n, sizes_.n) && d_dtheta.fits("d_dtheta", sizes_.n, sizes_.n) &&
          d_ddtheta.fits("d_ddtheta", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_inverse_dynamics_derivatives(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(),
        environment.c(), d_theta.c(), d_dtheta.c(), d_ddtheta.c()));
  }

  /// θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹, row i of θ̈_i; by θ along the velocities.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N. Gives ddtheta (n), rad/s² or m/s²; d_theta (n
  /// × n), rad/s² or m/s², each per unit of its column; d_dtheta (n × n), rad/s² or m/s², each per unit of its column;
  /// d_tau (n × n), rad/s² or m/s², each per unit of its column.
  Status forward_dynamics_derivatives(Input theta, Input dtheta, Input tau, Vector ddtheta, Matrix d_theta,
      Matrix d_dtheta, Matrix d_tau, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && tau.fits("tau", sizes_.n) &&
          ddtheta.fits("ddtheta", sizes_.n) && d_theta.fits("d_theta", sizes_.n, sizes_.n) && d_dtheta.fits("d_dtheta",
          sizes_.n, sizes_.n) && d_tau.fits("d_tau", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_forward_dynamics_derivatives(model_.get(), get(), theta.data(), dtheta.data(), tau.data(),
        environment.c(), ddtheta.data(), d_theta.c(), d_dtheta.c(), d_tau.c()));
  }

  /// xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇ and xᵀ∂τ/∂θ̈ = Mx, the gradient of xᵀτ; by θ along the velocities.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s²; x (n), any. Gives d_theta (n), any;
  /// d_dtheta (n), any; d_ddtheta (n), any.
  Status inverse_dynamics_vjp(Input theta, Input dtheta, Input ddtheta, Input x, Vector d_theta, Vector d_dtheta,
      Vector d_ddtheta, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          x.fits("x", sizes_.n) && d_theta.fits("d_theta", sizes_.n) && d_dtheta.fits("d_dtheta", sizes_.n) &&
          d_ddtheta.fits("d_ddtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_inverse_dynamics_vjp(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(),
        x.data(), environment.c(), d_theta.data(), d_dtheta.data(), d_ddtheta.data()));
  }

  /// xᵀ∂θ̈/∂θ, xᵀ∂θ̈/∂θ̇ and xᵀ∂θ̈/∂τ = M⁻¹x, the gradient of xᵀθ̈; by θ along the velocities.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N; x (n), any. Gives d_theta (n), any; d_dtheta
  /// (n), any; d_tau (n), any.
  Status forward_dynamics_vjp(Input theta, Input dtheta, Input tau, Input x, Vector d_theta, Vector d_dtheta,
      Vector d_tau, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && tau.fits("tau", sizes_.n) && x.fits("x",
          sizes_.n) && d_theta.fits("d_theta", sizes_.n) && d_dtheta.fits("d_dtheta", sizes_.n) && d_tau.fits("d_tau",
          sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_forward_dynamics_vjp(model_.get(), get(), theta.data(), dtheta.data(), tau.data(), x.data(),
        environment.c(), d_theta.data(), d_dtheta.data(), d_tau.data()));
  }

  /// xᵀ∂τ/∂π = xᵀY, and xᵀ∂τ by the joints' placements and axes and by gravity: the gradient of xᵀτ by the robot.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s²; x (n), any. Gives d_parameters (p),
  /// any; d_placements (b × 6), any; d_axes (b × 6), any; d_gravity (3), any.
  Status inverse_dynamics_parameter_vjp(Input theta, Input dtheta, Input ddtheta, Input x, Vector d_parameters,
      Matrix d_placements, Matrix d_axes, Vector d_gravity, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          x.fits("x", sizes_.n) && d_parameters.fits("d_parameters", sizes_.parameters) &&
          d_placements.fits("d_placements", sizes_.bodies, 6) && d_axes.fits("d_axes", sizes_.bodies, 6) &&
          d_gravity.fits("d_gravity", 3))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_inverse_dynamics_parameter_vjp(model_.get(), get(), theta.data(), dtheta.data(),
        ddtheta.data(), x.data(), environment.c(), d_parameters.data(), d_placements.c(), d_axes.c(),
        d_gravity.data()));
  }

  /// xᵀ∂θ̈/∂π, and xᵀ∂θ̈ by the joints' placements and axes and by gravity: the gradient of xᵀθ̈ by the robot.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; tau (n), N m or N; x (n), any. Gives d_parameters (p), any;
  /// d_placements (b × 6), any; d_axes (b × 6), any; d_gravity (3), any.
  Status forward_dynamics_parameter_vjp(Input theta, Input dtheta, Input tau, Input x, Vector d_parameters,
      Matrix d_placements, Matrix d_axes, Vector d_gravity, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && tau.fits("tau", sizes_.n) && x.fits("x",
          sizes_.n) && d_parameters.fits("d_parameters", sizes_.parameters) && d_placements.fits("d_placements",
          sizes_.bodies, 6) && d_axes.fits("d_axes", sizes_.bodies, 6) && d_gravity.fits("d_gravity", 3))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_forward_dynamics_parameter_vjp(model_.get(), get(), theta.data(), dtheta.data(), tau.data(),
        x.data(), environment.c(), d_parameters.data(), d_placements.c(), d_axes.c(), d_gravity.data()));
  }

  /// xᵀ∂(M(θ)θ̈)/∂θ along the velocities, and Mx: the gradient of xᵀMθ̈.
  /// theta (nq), rad or m; ddtheta (n), rad/s² or m/s²; x (n), any. Gives d_theta (n), any; d_ddtheta (n), any.
  Status mass_matrix_product_vjp(Input theta, Input ddtheta, Input x, Vector d_theta, Vector d_ddtheta) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && ddtheta.fits("ddtheta", sizes_.n) && x.fits("x", sizes_.n) &&
          d_theta.fits("d_theta", sizes_.n) && d_ddtheta.fits("d_ddtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_mass_matrix_product_vjp(model_.get(), get(), theta.data(), ddtheta.data(), x.data(),
        d_theta.data(), d_ddtheta.data()));
  }

  /// ∂𝒦/∂θ, ∂𝒦/∂θ̇ and ∂𝒫/∂θ of the kinetic and potential energy; by θ along the velocities.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives kinetic_d_theta (n), N m or N; kinetic_d_dtheta (n), N m s
  /// or N s; potential_d_theta (n), N m or N.
  Status energy_gradients(Input theta, Input dtheta, Vector kinetic_d_theta, Vector kinetic_d_dtheta,
      Vector potential_d_theta, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && kinetic_d_theta.fits("kinetic_d_theta",
          sizes_.n) && kinetic_d_dtheta.fits("kinetic_d_dtheta", sizes_.n) &&
          potential_d_theta.fits("potential_d_theta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_energy_gradients(model_.get(), get(), theta.data(), dtheta.data(), environment.c(),
        kinetic_d_theta.data(), kinetic_d_dtheta.data(), potential_d_theta.data()));
  }

  /// wᵀ∂𝒱_b/∂θ along the velocities, and J_bᵀw: the gradient of wᵀ𝒱_b, the twist of a frame in its own coordinates.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; w (6), any. Gives d_theta (n), any; d_dtheta (n), any.
  Status frame_twist_vjp(Input theta, Input dtheta, Input w, Frame frame, Vector d_theta, Vector d_dtheta) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && w.fits("w", 6) &&
          d_theta.fits("d_theta", sizes_.n) && d_dtheta.fits("d_dtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_frame_twist_vjp(model_.get(), get(), theta.data(), dtheta.data(), w.data(), frame.c(),
        d_theta.data(), d_dtheta.data()));
  }

  /// wᵀ∂a_b/∂θ along the velocities, wᵀ∂a_b/∂θ̇ and J_bᵀw: the gradient of wᵀa_b, a_b the acceleration of a frame.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s²; w (6), any. Gives d_theta (n), any;
  /// d_dtheta (n), any; d_ddtheta (n), any.
  Status frame_acceleration_vjp(Input theta, Input dtheta, Input ddtheta, Input w, Frame frame, Vector d_theta,
      Vector d_dtheta, Vector d_ddtheta) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          w.fits("w", 6) && d_theta.fits("d_theta", sizes_.n) && d_dtheta.fits("d_dtheta", sizes_.n) &&
          d_ddtheta.fits("d_ddtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_frame_acceleration_vjp(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(),
        w.data(), frame.c(), d_theta.data(), d_dtheta.data(), d_ddtheta.data()));
  }

  /// wᵀ∂h/∂θ along the velocities, and wᵀ∂h/∂θ̇: the gradient of wᵀh, h the momentum about a point of {s}.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; w (6), any. Gives d_theta (n), any; d_dtheta (n), any.
  Status momentum_vjp(Input theta, Input dtheta, Input w, Vector d_theta, Vector d_dtheta,
      const Point &about = Point()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && w.fits("w", 6) &&
          d_theta.fits("d_theta", sizes_.n) && d_dtheta.fits("d_dtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_momentum_vjp(model_.get(), get(), theta.data(), dtheta.data(), w.data(), about.c(),
        d_theta.data(), d_dtheta.data()));
  }

  /// wᵀ∂ḣ/∂θ along the velocities, wᵀ∂ḣ/∂θ̇ and wᵀ∂ḣ/∂θ̈: the gradient of wᵀḣ, ḣ the rate of the momentum.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s²; w (6), any. Gives d_theta (n), any;
  /// d_dtheta (n), any; d_ddtheta (n), any.
  Status momentum_rate_vjp(Input theta, Input dtheta, Input ddtheta, Input w, Vector d_theta, Vector d_dtheta,
      Vector d_ddtheta, const Point &about = Point()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          w.fits("w", 6) && d_theta.fits("d_theta", sizes_.n) && d_dtheta.fits("d_dtheta", sizes_.n) &&
          d_ddtheta.fits("d_ddtheta", sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_momentum_rate_vjp(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(), w.data(),
        about.c(), d_theta.data(), d_dtheta.data(), d_ddtheta.data()));
  }

  /// ∂g/∂θ.
  /// theta (nq), rad or m. Gives dg (n × n), N m or N, each per unit of its column.
  Status gravity_forces_derivative(Input theta, Matrix dg, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dg.fits("dg", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_gravity_forces_derivative(model_.get(), get(), theta.data(), environment.c(), dg.c()));
  }

  /// ∂(JᵀF)/∂θ of the wrenches that frames apply to the environment.
  /// theta (nq), rad or m. Gives dtau (n × n), N m or N, each per unit of its column.
  Status tip_forces_derivative(Input theta, Matrix dtau, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtau.fits("dtau", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_tip_forces_derivative(model_.get(), get(), theta.data(), environment.c(), dtau.c()));
  }

  /// ∂(M(θ)x)/∂θ for a constant x.
  /// theta (nq), rad or m; x (n), any. Gives dMx (n × n), that of M x, each per unit of its column.
  Status mass_matrix_product_derivative(Input theta, Input x, Matrix dMx) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && x.fits("x", sizes_.n) && dMx.fits("dMx", sizes_.n, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_mass_matrix_product_derivative(model_.get(), get(), theta.data(), x.data(), dMx.c()));
  }

  /// c, the centre of mass of all that moves, in {s}.
  /// theta (nq), rad or m. Gives c (3), m.
  Status center_of_mass(Input theta, Vector c) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && c.fits("c", 3))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_center_of_mass(model_.get(), get(), theta.data(), c.data()));
  }

  /// ċ of the centre of mass, in the axes of {s}.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives dc (3), m/s.
  Status center_of_mass_velocity(Input theta, Input dtheta, Vector dc) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && dc.fits("dc", 3))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_center_of_mass_velocity(model_.get(), get(), theta.data(), dtheta.data(), dc.data()));
  }

  /// c̈ of the centre of mass, in the axes of {s}.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². Gives ddc (3), m/s².
  Status center_of_mass_acceleration(Input theta, Input dtheta, Input ddtheta, Vector ddc) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          ddc.fits("ddc", 3))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_center_of_mass_acceleration(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(),
        ddc.data()));
  }

  /// J of the centre of mass: ċ = Jθ̇, in the axes of {s}.
  /// theta (nq), rad or m. Gives J (3 × n), m or 1.
  Status center_of_mass_jacobian(Input theta, Matrix J) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && J.fits("J", 3, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_center_of_mass_jacobian(model_.get(), get(), theta.data(), J.c()));
  }

  /// h, the momentum (angular, linear) of all that moves, about a point of {s}, in the axes of {s}.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives h (6), kg m²/s, kg m/s.
  Status momentum(Input theta, Input dtheta, Vector h, const Point &about = Point()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && h.fits("h", 6))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_momentum(model_.get(), get(), theta.data(), dtheta.data(), about.c(), h.data()));
  }

  /// ḣ of the momentum about a fixed point of {s}, along a motion.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². Gives dh (6), N m, N.
  Status momentum_rate(Input theta, Input dtheta, Input ddtheta, Vector dh, const Point &about = Point()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          dh.fits("dh", 6))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_momentum_rate(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(), about.c(),
        dh.data()));
  }

  /// A_G(θ), angular rows first: h_G = A_Gθ̇ is the momentum about the centre of mass.
  /// theta (nq), rad or m. Gives A (6 × n), kg m² or kg m, kg m or kg.
  Status centroidal_momentum_matrix(Input theta, Matrix A) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && A.fits("A", 6, sizes_.n))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_centroidal_momentum_matrix(model_.get(), get(), theta.data(), A.c()));
  }

  /// Ȧ_Gθ̇, of ḣ_G = A_Gθ̈ + Ȧ_Gθ̇.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives b (6), N m, N.
  Status centroidal_momentum_bias(Input theta, Input dtheta, Vector b) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && b.fits("b", 6))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_centroidal_momentum_bias(model_.get(), get(), theta.data(), dtheta.data(), b.data()));
  }

  /// Y(θ, θ̇, θ̈): τ = Yπ + JᵀF, with π the robot's parameters.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s; ddtheta (n), rad/s² or m/s². Gives Y (n × p), N m or N, each per
  /// unit of its parameter.
  Status regressor(Input theta, Input dtheta, Input ddtheta, Matrix Y, Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && ddtheta.fits("ddtheta", sizes_.n) &&
          Y.fits("Y", sizes_.n, sizes_.parameters))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_regressor(model_.get(), get(), theta.data(), dtheta.data(), ddtheta.data(), environment.c(),
        Y.c()));
  }

  /// the rows that give the kinetic and the potential energy of the parameters π.
  /// theta (nq), rad or m; dtheta (n), rad/s or m/s. Gives kinetic (p), J, each per unit of its parameter; potential
  /// (p), J, each per unit of its parameter.
  Status energy_regressors(Input theta, Input dtheta, Vector kinetic, Vector potential,
      Around environment = Around()) noexcept {
    if (!(theta.fits("theta", sizes_.nq) && dtheta.fits("dtheta", sizes_.n) && kinetic.fits("kinetic",
          sizes_.parameters) && potential.fits("potential", sizes_.parameters))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_energy_regressors(model_.get(), get(), theta.data(), dtheta.data(), environment.c(),
        kinetic.data(), potential.data()));
  }

  // End of the quantities.

 private:
  struct Sizes {
    std::size_t n, nq, parameters, bodies, frames, constraints;
  };

  struct Empty {};
  Workspace(Empty, const Model &model)
      : model_(model),
        sizes_{model_.n(),          model_.nq(),          model_.parameter_count(),
               model_.body_count(), model_.frame_count(), model_.constraint_rows()} {}
  template <class F>
  static Result<Workspace> created(const Model &model, F make) {
    Workspace workspace(Empty{}, model);
    Status status(make(workspace.handle_.put()));
    return status.ok() ? Result<Workspace>(std::move(workspace)) : Result<Workspace>(status);
  }

  Model model_;
  Sizes sizes_;
  detail::Handle<mozzi_workspace, mozzi_workspace_free> handle_;
};

/// A robot prepared for many states. Tables have the numbers of one state after those of the other.
class Batch {
 public:
  /// On this many threads, 0 for all cores.
  static Result<Batch> create(const Model &model, std::size_t threads = 0) {
    return created(model, [&](auto **b) { return mozzi_batch_new(model.get(), threads, b); });
  }
  /// Likewise, never by machine code, which changes the last digits once.
  static Result<Batch> kernels_only(const Model &model, std::size_t threads = 0) {
    return created(model, [&](auto **b) { return mozzi_batch_kernels_only(model.get(), threads, b); });
  }
  static Result<Batch> create(const Program &program, std::size_t threads = 0) {
    return created(program.model(), [&](auto **b) { return mozzi_batch_with_program(program.get(), threads, b); });
  }
  /// A quantity at many states. Allocates.
  Status compute(const Quantity &quantity, std::size_t states, std::initializer_list<mozzi_table> inputs,
                 std::initializer_list<mozzi_table_out> outputs,
                 const mozzi_batch_environment *environment = nullptr) const noexcept {
    const mozzi_subject subject = quantity.c();
    return Status(mozzi_batch_compute(get(), quantity.number, &subject, states, inputs.begin(), inputs.size(),
                                      environment, outputs.begin(), outputs.size()));
  }
  /// Replaces many robots' states, θ (states × nq) and θ̇ (states × n), by those after the steps: see mozzi.h.
  Status simulate(std::size_t states, Vector theta, Vector dtheta, Input tau, std::int32_t method, double duration,
                  std::size_t steps, const mozzi_batch_environment *environment = nullptr) const noexcept {
    if (!(theta.fits("theta", states * nq_) && dtheta.fits("dtheta", states * n_) && tau.fits("tau", states * n_))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_batch_simulate(get(), states, theta.data(), dtheta.data(), tau.data(), environment, method,
                                       duration, steps));
  }
  const mozzi_batch *get() const noexcept { return handle_.get(); }

 private:
  explicit Batch(const Model &model) : nq_(model.nq()), n_(model.n()) {}
  template <class F>
  static Result<Batch> created(const Model &model, F make) {
    Batch batch(model);
    Status status(make(batch.handle_.put()));
    return status.ok() ? Result<Batch>(std::move(batch)) : Result<Batch>(status);
  }

  std::size_t nq_, n_;
  detail::Handle<mozzi_batch, mozzi_batch_free> handle_;
};

/// How to simulate: see mozzi.h.
struct SimulationOptions : mozzi_simulation_options {
  SimulationOptions(double seconds, std::size_t count) : mozzi_simulation_options{} {
    mozzi_simulation_defaults(seconds, count, this);
  }
};

namespace detail {

template <class T>
constexpr bool is_null = std::is_null_pointer_v<Plain<T>>;

template <class Torque, class Record>
struct Callbacks {
  Torque &torque;
  Record &record;
  std::exception_ptr thrown;

  template <class F>
  std::int32_t guarded(F call) noexcept {
#if MOZZI_HAS_EXCEPTIONS
    try {
      return call();
    } catch (...) {
      thrown = std::current_exception();
      return 1;
    }
#else
    return call();
#endif
  }
};

}  // namespace detail

/// The motion from (θ, θ̇). `torque(t, theta, dtheta, tau)` adds to tau, n numbers that are 0; `record(sample)` takes a
/// row and may return whether to go on; each may be nullptr. What they throw is thrown again here.
template <class Torque, class Record>
Result<mozzi_ending> simulate(const Model &model, const SimulationOptions &options, Input theta, Input dtheta,
                              Torque &&torque, Record &&record, const Program *program = nullptr) {
  if (!(theta.fits("theta", model.nq()) && dtheta.fits("dtheta", model.n()))) {
    return Result<mozzi_ending>(Status(MOZZI_WRONG_LENGTH));
  }
  using Callbacks = detail::Callbacks<std::remove_reference_t<Torque>, std::remove_reference_t<Record>>;
  Callbacks callbacks{torque, record, nullptr};
  const mozzi_torque on_torque = [](void *user, double t, const double *q, const double *v, double *tau) {
    auto &own = *static_cast<Callbacks *>(user);
    return own.guarded([&]() -> std::int32_t {
      if constexpr (!detail::is_null<Torque>) {
        own.torque(t, q, v, tau);
      }
      return 0;
    });
  };
  const mozzi_record on_record = [](void *user, const mozzi_sample *sample) {
    auto &own = *static_cast<Callbacks *>(user);
    return own.guarded([&]() -> std::int32_t {
      if constexpr (detail::is_null<Record>) {
        return 0;
      } else if constexpr (std::is_void_v<decltype(own.record(*sample))>) {
        own.record(*sample);
        return 0;
      } else {
        return own.record(*sample) ? 0 : 1;
      }
    });
  };
  mozzi_ending ending{};
  Status status(mozzi_simulate(model.get(), program == nullptr ? nullptr : program->get(), &options, theta.data(),
                               dtheta.data(), on_torque, on_record, &callbacks, &ending));
#if MOZZI_HAS_EXCEPTIONS
  if (callbacks.thrown) {
    std::rethrow_exception(callbacks.thrown);
  }
#endif
  return status.ok() ? Result<mozzi_ending>(ending) : Result<mozzi_ending>(status);
}

/// Joint positions that place a frame at a goal. For one call at a time.
class InverseKinematics {
 public:
  struct Options : mozzi_inverse_kinematics_options {
    Options() : mozzi_inverse_kinematics_options{} { mozzi_inverse_kinematics_defaults(this); }
  };

  static Result<InverseKinematics> create(const Model &model, Frame frame, const Options &options = Options()) {
    InverseKinematics solver;
    solver.nq_ = model.nq();
    Status status(mozzi_inverse_kinematics_new(model.get(), frame.c(), &options, solver.handle_.put()));
    return status.ok() ? Result<InverseKinematics>(std::move(solver)) : Result<InverseKinematics>(status);
  }
  /// From a guess to θ with T_sb(θ) = T; among several the nearest to `near_theta`, if given.
  Status solve(const Pose &T, Input guess, Vector theta, const double *near_theta = nullptr,
               mozzi_solution *solution = nullptr) noexcept {
    return T.status().ok() ? solve(MOZZI_GOAL_POSE, T.data(), guess, theta, near_theta, solution) : T.status();
  }
  /// To a position of the frame's origin, at any orientation.
  Status solve_position(const std::array<double, 3> &p, Input guess, Vector theta, const double *near_theta = nullptr,
                        mozzi_solution *solution = nullptr) noexcept {
    return solve(MOZZI_GOAL_POSITION, p.data(), guess, theta, near_theta, solution);
  }
  Status solve_position(Input p, Input guess, Vector theta, const double *near_theta = nullptr,
                        mozzi_solution *solution = nullptr) noexcept {
    return p.fits("the position", 3) ? solve(MOZZI_GOAL_POSITION, p.data(), guess, theta, near_theta, solution)
                                     : Status(MOZZI_WRONG_LENGTH);
  }
  /// To an orientation R_sb, 9 numbers by rows, at any position.
  Status solve_orientation(const std::array<double, 9> &R, Input guess, Vector theta,
                           const double *near_theta = nullptr, mozzi_solution *solution = nullptr) noexcept {
    return solve(MOZZI_GOAL_ORIENTATION, R.data(), guess, theta, near_theta, solution);
  }

 private:
  InverseKinematics() = default;
  Status solve(std::int32_t kind, const double *goal, Input guess, Vector theta, const double *near_theta,
               mozzi_solution *solution) noexcept {
    if (!(guess.fits("guess", nq_) && theta.fits("theta", nq_))) {
      return Status(MOZZI_WRONG_LENGTH);
    }
    return Status(mozzi_inverse_kinematics_solve(handle_.get(), kind, goal, guess.data(), near_theta, theta.data(),
                                                 solution));
  }

  detail::Handle<mozzi_inverse_kinematics, mozzi_inverse_kinematics_free> handle_;
  std::size_t nq_ = 0;
};

}  // namespace mozzi

#endif
