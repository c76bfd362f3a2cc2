//! Files that hold no lines of a log, known by their first bytes.

/// A kind of file.
struct Kind {
    begins: &'static [&'static [u8]],
    name: &'static str,
    /// How to make lines of it.
    help: &'static str,
}

const KINDS: &[Kind] = &[
    Kind { begins: &[b"\x1F\x8B"], name: "is compressed by gzip", help: "write `zcat FILE.gz | canspec decode -`" },
    Kind {
        begins: &[b"\x28\xB5\x2F\xFD"],
        name: "is compressed by zstd",
        help: "write `zstdcat FILE.zst | canspec decode -`",
    },
    Kind { begins: &[b"\xFD7zXZ\0"], name: "is compressed by xz", help: "write `xzcat FILE.xz | canspec decode -`" },
    Kind { begins: &[b"BZh"], name: "is compressed by bzip2", help: "write `bzcat FILE.bz2 | canspec decode -`" },
    Kind { begins: &[b"PK\x03\x04"], name: "is a ZIP archive", help: "write `unzip -p FILE.zip | canspec decode -`" },
    Kind {
        begins: &[b"LOGG"],
        name: "is a binary log of Vector (BLF)",
        help: "`can_logconvert FILE.blf FILE.log` of python-can makes a text of it",
    },
    Kind {
        begins: &[b"MDF     ", b"UnFinMF "],
        name: "is a measurement file (MDF)",
        help: "`can_logconvert FILE.mf4 FILE.log` of python-can and asammdf makes a text of it",
    },
    Kind {
        begins: &[b"\n\r\r\n", b"\xD4\xC3\xB2\xA1", b"\xA1\xB2\xC3\xD4", b"\x4D\x3C\xB2\xA1", b"\xA1\xB2\x3C\x4D"],
        name: "is a capture (pcap or pcapng)",
        help: "tshark makes a table of it, by the call that `canspec decode --help` shows",
    },
    Kind {
        begins: &[b"\xFF\xFE", b"\xFE\xFF"],
        name: "is text in UTF-16",
        help: "`iconv -f UTF-16 -t UTF-8 FILE` makes UTF-8 of it",
    },
];

/// Says what a file with these first bytes is, and what makes lines of it. Lines of logs give `None`.
pub fn foreign(start: &[u8]) -> Option<String> {
    let kind = KINDS.iter().find(|kind| kind.begins.iter().any(|begin| start.starts_with(begin)))?;
    Some(format!("the file {}; {}", kind.name, kind.help))
}
