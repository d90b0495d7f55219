//! Further pictures of the cloth, laid over the first.

use crate::tools::picture::draft::{Draft, Part};
use crate::tools::picture::found::{Correlated, Found, Laid};
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_textile::n_threads;
use selvedge_textile::picture::{
    EvenLight, Picture, PictureError, Turned, TurnedPicture, even_light,
};

/// Whether uneven light is divided out.
pub(super) fn even(inputs: &Draft) -> EvenLight {
    if inputs.is_evened {
        EvenLight::Auto
    } else {
        EvenLight::Off
    }
}

/// Lays the further pictures over the first.
pub(super) fn turned(
    inputs: &Draft,
    correlated: &Correlated,
    progress: &mut Progress<'_>,
) -> Result<Vec<Laid>, Cancelled> {
    let mut all = Vec::new();
    for file in &inputs.turned {
        let picture = match file.bytes() {
            _ if inputs.part != Part::Whole => {
                Err("further pictures go with the whole picture; choose part “all”".to_owned())
            }
            Ok(bytes) => Picture::load(bytes, file.file_name())
                .map(|picture| (picture, sha256_hex([bytes])))
                .map_err(|error| error.to_string()),
            Err(line) => Err(line.to_owned()),
        };
        let (picture, sha256) = match picture {
            Ok(read) => read,
            Err(line) => {
                all.push(Err(line));
                continue;
            }
        };
        let (luminance, _) = even_light(picture.luminance, even(inputs));
        let other = (&luminance, file.file_name());
        all.push(
            match Turned::of(&correlated.luminance, other, n_threads(), progress) {
                Ok(one) => {
                    let kept = one.kept(file.name(), sha256);
                    Ok((one, kept))
                }
                Err(PictureError::Cancelled(cancelled)) => return Err(cancelled),
                Err(error) => Err(error.to_string()),
            },
        );
    }
    Ok(all)
}

/// Further pictures that could be laid over the first, and as a textile names them.
pub(super) fn laid(found: &Found) -> (Vec<Turned>, Vec<TurnedPicture>) {
    let all = found.turned.iter().flat_map(|all| all.iter());
    all.flatten().cloned().unzip()
}
