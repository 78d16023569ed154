//! A library's copy to be loaded: the original may be built anew meanwhile, and a loaded file that is cut short takes the
//! process with it. What stands in the way, as a person needs to hear it.

use std::error::Error;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Removed when dropped: once it is loaded it is no longer needed under a name.
pub struct Copy(pub PathBuf);

impl Copy {
    pub fn of(path: &Path) -> Result<Copy, String> {
        let folder = std::env::temp_dir();
        let name = format!("lrp-{}-{}", std::process::id(), path.file_name().unwrap_or_default().display());
        let copy = Copy(folder.join(name));
        fs::copy(path, &copy.0).map_err(|error| {
            let folder = folder.display();
            format!("it can't be copied to {folder} to be loaded: {error}; is there room? TMPDIR names another folder")
        })?;
        match copy.is_whole() {
            Ok(false) => {
                Err("it can't be loaded: it is cut short; is it still being written, or was the disk full?".into())
            }
            _ => Ok(copy),
        }
    }

    /// Unless it is an ELF file that ends before its table of sections, which comes last, does. To load that would crash.
    fn is_whole(&self) -> io::Result<bool> {
        let mut file = File::open(&self.0)?;
        let mut header = [0; 64];
        file.read_exact(&mut header)?;
        if !header.starts_with(b"\x7fELF\x02\x01") {
            return Ok(true);
        }
        let [mut offset, mut size, mut count] = [[0; 8], [0; 8], [0; 8]];
        offset.copy_from_slice(&header[40..48]);
        size[..2].copy_from_slice(&header[58..60]);
        count[..2].copy_from_slice(&header[60..62]);
        let table = u64::from_le_bytes(size) * u64::from_le_bytes(count);
        Ok(u64::from_le_bytes(offset).saturating_add(table) <= file.metadata()?.len())
    }

    /// The system's words name the copy, and say little.
    pub fn explain(&self, error: &libloading::Error) -> String {
        let words = error.source().map_or_else(|| error.to_string(), ToString::to_string);
        let Some(words) = words.strip_prefix(&format!("{}: ", self.0.display())) else {
            return format!("it can't be loaded: {words}");
        };
        let help = match words.contains("map segment") {
            true => "may programs run from there (`noexec`)? TMPDIR names another folder",
            false => "is it whole, and built for this computer?",
        };
        format!("it can't be loaded from {}: {words}; {help}", self.0.parent().unwrap_or(&self.0).display())
    }
}

impl Drop for Copy {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}
