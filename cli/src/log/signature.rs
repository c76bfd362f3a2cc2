//! Files that hold no lines of a log, known by their first bytes.

/// A kind of file.
struct Kind {
    begins: &'static [&'static [u8]],
    name: &'static str,
    /// How to make lines of it.
    help: &'static str,
}

const KINDS: &[Kind] = &[
    Kind {
        begins: &[b"\x1F\x8B"],
        name: "is compressed by gzip",
        help: "write `zcat FILE.gz |` before this call, and `-` in place of the file",
    },
    Kind {
        begins: &[b"\x28\xB5\x2F\xFD"],
        name: "is compressed by zstd",
        help: "write `zstdcat FILE.zst |` before this call, and `-` in place of the file",
    },
    Kind {
        begins: &[b"\xFD7zXZ\0"],
        name: "is compressed by xz",
        help: "write `xzcat FILE.xz |` before this call, and `-` in place of the file",
    },
    Kind {
        begins: &[b"BZh"],
        name: "is compressed by bzip2",
        help: "write `bzcat FILE.bz2 |` before this call, and `-` in place of the file",
    },
    Kind {
        begins: &[b"PK\x03\x04"],
        name: "is a ZIP archive",
        help: "write `unzip -p FILE.zip |` before this call, and `-` in place of the file",
    },
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
        begins: &[b"SQLite format 3\0"],
        name: "is a database of SQLite",
        help: "`can_logconvert FILE.db FILE.log` makes a text of it if python-can wrote it",
    },
    Kind {
        begins: &[b"***BUSMASTER"],
        name: "is a log of BUSMASTER",
        help: "SavvyCAN opens it and saves it as GVRET, which canspec reads",
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

/// Says what a log with such a line is, if lines alone show it, and what makes lines of it that can be read.
pub fn foreign_line(line: &str) -> Option<String> {
    let mut words = line.split_ascii_whitespace();
    let time = words.next()?.parse::<f64>().is_ok();
    let record = words.next()?.trim_start_matches(|digit: char| digit.is_ascii_digit());
    let is_crtd = time && ["R11", "R29", "T11", "T29", "CXX", "CEV", "CBC"].contains(&record);
    is_crtd
        .then(|| "the file is a log in CRTD; SavvyCAN opens it and saves it as GVRET, which canspec reads".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_that_canspec_does_not_read_are_known_by_name() {
        // As their programs write them.
        assert!(foreign(b"***BUSMASTER Ver 3.2.2***\n").expect("it is known").contains("BUSMASTER"));
        assert!(foreign(b"SQLite format 3\0\x10\0").expect("it is known").contains("SQLite"));
        for line in ["1542473901.020305 1CXX Info Type:crtd", "1542473901.020305 R29 1abcdef0 01 02", "7.5 2T11 7e8 03"]
        {
            assert!(foreign_line(line).expect("it is known").contains("CRTD"), "{line}");
        }
        assert_eq!(foreign_line("1.5 1  123  Rx   d 2 11 22"), None);
    }
}
