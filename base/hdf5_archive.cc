#include "base/hdf5_archive.h"

#include "base/seal.h"
#include "base/whole_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace feldspar
{
namespace
{
constexpr std::size_t growth = std::size_t(1) << 20; ///< of a file in memory, in bytes

void add_notice(const H5::Group& root)
{
  std::uint32_t sealed = 1;
  Hdf5Writer(root).value(std::string(seal_notice), sealed);
}

/// The bytes of a file that `write` fills. In memory, because the library hides why a disk refused them, and does not
/// get over it. Under the lock.
std::string image_of(const std::filesystem::path& file, const std::function<void(const H5::Group&)>& write)
{
  try
    {
      H5::FileAccPropList in_memory;
      in_memory.setCore(growth, false);
      const H5::H5File out(file.string(), H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, in_memory);
      {
        const H5::Group root = out.openGroup("/");
        add_notice(root);
        write(root);
      }
      out.flush(H5F_SCOPE_GLOBAL);
      const ssize_t size = H5Fget_file_image(out.getId(), nullptr, 0);
      std::string image(std::size_t(std::max(ssize_t(0), size)), '\0');
      if (size <= 0 || H5Fget_file_image(out.getId(), image.data(), image.size()) != size)
        throw std::runtime_error(fmt::format("{}: HDF5 gives no image of the file", file.string()));
      return image;
    }
  catch (const H5::Exception& error) // which is no std::exception
    {
      throw std::runtime_error(fmt::format("{}: {}", file.string(), error.getDetailMsg()));
    }
}

/// Throws InputError for what is wrong in the file, without its name.
void read_from(const H5::H5File& in, const std::uint64_t size, const std::string& expected,
               const std::function<void(Hdf5Reader&)>& use, std::optional<H5::Group> copy = {})
{
  try
    {
      Hdf5Reader reader(in.openGroup("/"), size, std::move(copy));
      use(reader);
    }
  catch (const H5::Exception&)
    {
      throw InputError(fmt::format("not an HDF5 file, cut short, or not {}", expected));
    }
}

H5::H5File open_to_read(const std::filesystem::path& file, const std::string& expected,
                        const H5::FileAccPropList& access = H5::FileAccPropList::DEFAULT)
{
  try
    {
      return {file.string(), H5F_ACC_RDONLY, H5::FileCreatPropList::DEFAULT, access};
    }
  catch (const H5::Exception&)
    {
      throw InputError(fmt::format("not an HDF5 file, cut short, or not {}", expected));
    }
}

// A child process says in its first character what follows.
constexpr char is_image = '=';
constexpr char is_problem = '!';

/// The time and memory that a child needs for a file of so many bytes, with much to spare.
void limit_process(const std::uint64_t file_size)
{
  const auto limit = [](const auto resource, const std::uint64_t most) {
    const rlimit wanted{rlim_t(most), rlim_t(most)};
    setrlimit(resource, &wanted);
  };
  constexpr std::uint64_t megabyte = std::uint64_t(1) << 20;
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, 2 + file_size / (10 * megabyte)); // seconds; a second reads some 500 MB
  std::uint64_t pages = 0;
  if (std::ifstream("/proc/self/statm") >> pages)
    limit(RLIMIT_AS, pages * std::uint64_t(sysconf(_SC_PAGESIZE)) + 256 * megabyte + 16 * file_size);
}

/// The work of the child: copies what `use` reads, or says what is wrong, into a pipe.
[[noreturn]] void copy_as_child(const int pipe, const std::filesystem::path& file, const std::string& expected,
                                const std::function<void(Hdf5Reader&)>& use)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal :
       {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU, SIGFPE, SIGSEGV, SIGBUS, SIGILL, SIGABRT, SIGPIPE})
    std::signal(signal, SIG_DFL);
  if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0)
    dup2(nowhere, STDERR_FILENO); // the last words of libraries
  std::string reply;
  try
    {
      const std::uint64_t size = std::filesystem::file_size(file);
      limit_process(size);
      const H5::H5File in = open_to_read(file, expected);
      reply = is_image + image_of(file, [&](const H5::Group& root) { read_from(in, size, expected, use, root); });
    }
  catch (const std::exception& error)
    {
      reply = is_problem + std::string(error.what());
    }
  for (std::size_t at = 0; at < reply.size();)
    if (const ssize_t n = write(pipe, reply.data() + at, reply.size() - at); n > 0)
      at += std::size_t(n);
    else
      break;
  _exit(0);
}

/// A child process that is ended with this object.
class Child
{
public:
  explicit Child(const pid_t number)
    : pid(number)
  {
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child()
  {
    if (pid > 0)
      {
        kill(pid, SIGKILL);
        wait();
      }
  }

  /// Its status by <sys/wait.h>; none where another has taken it.
  std::optional<int> wait()
  {
    int status = 0;
    pid_t ended = 0;
    do
      ended = waitpid(pid, &status, 0);
    while (ended < 0 && errno == EINTR);
    pid = 0;
    return ended > 0 ? std::optional(status) : std::nullopt;
  }

private:
  pid_t pid;
};

struct Descriptor
{
  explicit Descriptor(const int opened)
    : number(opened)
  {
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close_now(); }
  void close_now()
  {
    if (number >= 0)
      close(number);
    number = -1;
  }
  int number;
};

/// A copy of what `use` reads, as the bytes of a file, which this program wrote. Throws InputError for what is wrong in the
/// file, without its name. Under the lock.
std::string copy_by_child(const std::filesystem::path& file, const std::string& expected,
                          const std::function<void(Hdf5Reader&)>& use, const std::function<void()>& check)
{
  const auto fail = [&](const char* what) {
    throw std::runtime_error(fmt::format("{}: {}: {}", file.string(), what, std::generic_category().message(errno)));
  };
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    fail("no pipe to read it safely");
  Descriptor out(ends[0]), in(ends[1]);
  const pid_t pid = fork();
  if (pid < 0)
    fail("no process to read it safely");
  if (pid == 0)
    copy_as_child(in.number, file, expected, use);
  Child child(pid);
  in.close_now();

  std::string reply;
  std::vector<char> piece(std::size_t(1) << 16);
  for (;;)
    {
      constexpr int a_moment = 100; // ms
      check();
      pollfd wanted{out.number, POLLIN, 0};
      if (poll(&wanted, 1, a_moment) <= 0)
        continue;
      const ssize_t n = ::read(out.number, piece.data(), piece.size());
      if (n < 0 && errno == EINTR)
        continue;
      if (n <= 0)
        break;
      reply.append(piece.data(), std::size_t(n));
    }
  const std::optional<int> status = child.wait();
  check();
  if (status && WIFSIGNALED(*status))
    {
      const int signal = WTERMSIG(*status);
      throw InputError(signal == SIGXCPU || signal == SIGKILL
                         ? "damaged: the HDF5 library finds no end in it"
                         : fmt::format("damaged: the HDF5 library fails on it (SIG{})", sigabbrev_np(signal)));
    }
  if (reply.empty() || reply[0] != is_image)
    throw InputError(reply.empty() ? "cannot be read" : reply.substr(1));
  reply.erase(0, 1);
  return reply;
}

/// `foreign`: how a file without a seal is read; where there is none it is refused.
void read(const std::filesystem::path& file, const std::string& expected, const std::function<void(Hdf5Reader&)>& use,
          const std::function<void()>& foreign)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  try
    {
      if (!std::filesystem::is_regular_file(file))
        throw InputError("no such file");
      // Before HDF5 sees it, which is not made for damaged files.
      const Seal seal = examine_seal(file);
      if (seal == Seal::broken)
        throw InputError("damaged or cut short: its content is not that of its checksum");
      if (seal == Seal::none && !foreign)
        throw InputError("damaged or cut short, or not of this version of the program: it has no checksum");
      if (seal == Seal::none)
        foreign();
      else
        read_from(open_to_read(file, expected), std::filesystem::file_size(file), expected, use);
    }
  catch (const InputError& error)
    {
      throw InputError(fmt::format("{}: {}; {} is expected", file.string(), error.what(), expected));
    }
}
} // namespace

void write_hdf5(const std::filesystem::path& file, const std::function<void(Hdf5Writer&)>& write)
{
  std::string image;
  {
    const std::lock_guard lock(hdf5_mutex());
    H5::Exception::dontPrint();
    image = image_of(file, [&](const H5::Group& root) {
      Hdf5Writer writer(root);
      write(writer);
    });
  }
  image += seal_of(image);
  write_whole_file(file, image);
}

void seal_hdf5(const std::filesystem::path& file)
{
  const std::lock_guard lock(hdf5_mutex());
  H5::Exception::dontPrint();
  try
    {
      const H5::H5File opened(file.string(), H5F_ACC_RDWR);
      add_notice(opened.openGroup("/"));
    }
  catch (const H5::Exception& error)
    {
      throw OutputError(fmt::format("{}: cannot be sealed: {}", file.string(), error.getDetailMsg()));
    }
  std::ifstream in(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::app);
  if (!in || !(out << seal_of(content)).flush())
    throw OutputError(fmt::format("{}: cannot be sealed{}", file.string(),
                                  errno != 0 ? ": " + std::generic_category().message(errno) : ""));
}

void read_hdf5(const std::filesystem::path& file, const std::string& expected,
               const std::function<void(Hdf5Reader&)>& use)
{
  read(file, expected, use, nullptr);
}

void read_foreign_hdf5(const std::filesystem::path& file, const std::string& expected,
                       const std::function<void(Hdf5Reader&)>& use, const std::function<void()>& check)
{
  read(file, expected, use, [&] {
    const std::string image = copy_by_child(file, expected, use, check);
    H5::FileAccPropList in_memory;
    in_memory.setCore(growth, false);
    if (H5Pset_file_image(in_memory.getId(), const_cast<char*>(image.data()), image.size()) < 0)
      throw std::runtime_error(fmt::format("{}: HDF5 takes no image of the file", file.string()));
    // An image has a name under which there is no file.
    read_from(open_to_read(file / "copy", expected, in_memory), image.size(), expected, use);
  });
}
} // namespace feldspar
