"""The reserved names of C and C++, and of the libraries and engines that include a C header."""

from __future__ import annotations

from typing import Final

_WORDS = """
    auto bool break case char const constexpr continue default do double else enum extern false float for goto if
    inline int long nullptr register restrict return short signed sizeof static struct switch true typedef typeof
    union unsigned void volatile while alignas alignof static_assert thread_local noreturn asm fortran and and_eq
    bitand bitor compl not not_eq or or_eq xor xor_eq catch char8_t char16_t char32_t class co_await co_return
    co_yield concept const_cast consteval constinit decltype delete dynamic_cast explicit export final friend import
    module mutable namespace new noexcept operator override private protected public reinterpret_cast requires
    static_cast template this throw try typeid typename using virtual wchar_t
""".split()

_LIBRARY = """
    abs acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh drem erf erfc exp exp10 exp2 expm1 fabs
    fdim floor fma fmax fmin fmod frexp gamma hypot ilogb infinity isfinite isgreater isgreaterequal isinf isless
    islessequal islessgreater isnan isnormal isunordered j0 j1 jn ldexp lgamma llrint llround log log10 log1p log2
    logb lrint lround modf nan nearbyint nextafter nexttoward pow pow10 remainder remquo rint round scalb scalbln
    scalbn signbit signgam significand sin sinh sqrt tan tanh tgamma trunc y0 y1 yn fpclassify FP_INFINITE FP_NAN
    FP_NORMAL FP_SUBNORMAL FP_ZERO HUGE HUGE_VAL INFINITY NAN OVERFLOW UNDERFLOW DOMAIN SING PLOSS TLOSS BUFSIZ EOF
    FILE NULL SEEK_CUR SEEK_END SEEK_SET clearerr fclose feof ferror fflush fgetc fgetpos fgets fopen fprintf fputc
    fputs fread freopen fscanf fseek fsetpos ftell fwrite getc getchar gets perror printf putc putchar puts remove
    rename rewind scanf setbuf setvbuf snprintf sprintf sscanf stderr stdin stdout tmpfile tmpnam ungetc vfprintf
    vprintf vsnprintf vsprintf abort atexit atof atoi atol bsearch calloc div exit free getenv labs ldiv malloc
    qsort rand realloc srand strtod strtol strtoul system memchr memcmp memcpy memmove memset strcat strchr strcmp
    strcoll strcpy strcspn strerror strlen strncat strncmp strncpy strpbrk strrchr strspn strstr strtok strxfrm
    index rindex size_t ptrdiff_t offsetof tolower toupper isspace errno assert complex imaginary I main
""".split()

# Macros of the standard headers on Linux, Windows and macOS; the last ones are error codes.
_CONSTANTS = """
    BIG_ENDIAN LITTLE_ENDIAN PDP_ENDIAN BYTE_ORDER EXIT_FAILURE EXIT_SUCCESS FD_SETSIZE NFDBITS FILENAME_MAX
    FOPEN_MAX TMP_MAX RAND_MAX MB_CUR_MAX MAXFLOAT FP_ILOGB0 FP_ILOGBNAN FP_LLOGB0 FP_LLOGBNAN FP_INT_DOWNWARD
    FP_INT_TONEAREST FP_INT_TONEARESTFROMZERO FP_INT_TOWARDZERO FP_INT_UPWARD FP_FAST_FMA FP_FAST_FMAF
    FP_FAST_FMAL FP_QNAN FP_SNAN FP_SUPERNORMAL L_ctermid L_cuserid L_tmpnam P_tmpdir MATH_ERREXCEPT MATH_ERRNO
    math_errhandling RENAME_EXCHANGE RENAME_NOREPLACE RENAME_WHITEOUT RENAME_SECLUDE RENAME_SWAP RENAME_EXCL
    SEEK_DATA SEEK_HOLE TLTL_MAIN WCONTINUED WEXITED WNOHANG WNOWAIT WSTOPPED WUNTRACED WCOREFLAG
    E2BIG EACCES EADDRINUSE EADDRNOTAVAIL EADV EAFNOSUPPORT EAGAIN EALREADY EAUTH EBADARCH EBADE EBADEXEC EBADF
    EBADFD EBADMACHO EBADMSG EBADR EBADRPC EBADRQC EBADSLT EBFONT EBUSY ECANCELED ECHILD ECHRNG ECOMM ECONNABORTED
    ECONNREFUSED ECONNRESET EDEADLK EDEADLOCK EDESTADDRREQ EDEVERR EDOM EDOTDOT EDQUOT EEXIST EFAULT EFBIG EFTYPE
    EHOSTDOWN EHOSTUNREACH EHWPOISON EIDRM EILSEQ EINPROGRESS EINTR EINVAL EIO EISCONN EISDIR EISNAM EKEYEXPIRED
    EKEYREJECTED EKEYREVOKED EL2HLT EL2NSYNC EL3HLT EL3RST ELAST ELIBACC ELIBBAD ELIBEXEC ELIBMAX ELIBSCN ELNRNG
    ELOOP EMEDIUMTYPE EMFILE EMLINK EMSGSIZE EMULTIHOP ENAMETOOLONG ENAVAIL ENEEDAUTH ENETDOWN ENETRESET
    ENETUNREACH ENFILE ENOANO ENOATTR ENOBUFS ENOCSI ENODATA ENODEV ENOENT ENOEXEC ENOKEY ENOLCK ENOLINK ENOMEDIUM
    ENOMEM ENOMSG ENONET ENOPKG ENOPOLICY ENOPROTOOPT ENOSPC ENOSR ENOSTR ENOSYS ENOTBLK ENOTCONN ENOTDIR
    ENOTEMPTY ENOTNAM ENOTRECOVERABLE ENOTSOCK ENOTSUP ENOTTY ENOTUNIQ ENXIO EOPNOTSUPP EOTHER EOVERFLOW
    EOWNERDEAD EPERM EPFNOSUPPORT EPIPE EPROCLIM EPROCUNAVAIL EPROGMISMATCH EPROGUNAVAIL EPROTO EPROTONOSUPPORT
    EPROTOTYPE EPWROFF EQFULL ERANGE EREMCHG EREMOTE EREMOTEIO ERESTART ERFKILL EROFS ERPCMISMATCH ESHLIBVERS
    ESHUTDOWN ESOCKTNOSUPPORT ESPIPE ESRCH ESRMNT ESTALE ESTRPIPE ETIME ETIMEDOUT ETOOMANYREFS ETXTBSY EUCLEAN
    EUNATCH EUSERS EWOULDBLOCK EXDEV EXFULL
""".split()

# Macros that systems define once for each floating-point type.
_NUMBERS = """
    HUGE_VAL SNAN M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2
""".split()
_ENDINGS = (
    *("", "f", "l", "F", "L"),
    *(f"{sign}{size}" for sign in ("f", "F", "_F") for size in ("32", "64", "128", "32x", "64x", "32X", "64X")),
)

# Macros of other headers of systems and engines: windows.h, X11, Qt, macOS, Unreal, and gcc's built-in ones.
_MACROS = """
    near far NEAR FAR min max small hyper interface pascal cdecl CDECL PASCAL IN OUT OPTIONAL CONST VOID ERROR DELETE
    TRUE FALSE BOOL BYTE CHAR INT LONG SHORT FLOAT DOUBLE STRICT THIS INTERFACE ABSOLUTE RELATIVE TRANSPARENT OPAQUE
    NO_ERROR IGNORE INFINITE CALLBACK WINAPI WINVER UNICODE RGB DIFFERENCE REASON_UNKNOWN uuid
    Bool Status True False None Success Always Never Above Below Complex Convex KeyPress KeyRelease FocusIn FocusOut
    CursorShape Unsorted GrayScale Expose signals slots emit foreach forever Q_OBJECT
    check verify require ensure checkf verifyf ensureAlways TEXT PI MIN MAX ABS SWAP CLAMP nil Nil YES NO
    linux unix i386 vax sun mips arm major minor makedev
""".split()

RESERVED: Final = (
    *_WORDS,
    *(f"{name}{kind}" for name in _LIBRARY for kind in ("", "f", "l")),
    *_CONSTANTS,
    *(f"{name}{ending}" for name in _NUMBERS for ending in _ENDINGS),
    *_MACROS,
)
"""Names that no variable of a C program may have: keywords, functions and macros."""
