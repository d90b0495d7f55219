//! From a device's units to millimetres of the workspace.
//!
//! A device counts x to the right and y downwards; the workspace has y upwards. Where the driver
//! states its resolution, a millimetre on the device is one in the workspace, with the device's
//! middle on the workspace's; where it does not, the device's whole surface is laid over the
//! workspace. Either can be replaced by an area that is named.

use std::str::FromStr;

use super::super::InputError;
use selvedge_foundation::geometry::Point;

/// What a driver tells of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AxisRange {
    /// The smallest value.
    pub min: i32,
    /// The largest value.
    pub max: i32,
    /// Units a millimetre; 0 where it is not stated.
    pub per_mm: i32,
}

impl AxisRange {
    /// How long the axis is, mm, where that is stated.
    pub fn length_mm(&self) -> Option<f64> {
        (self.per_mm > 0).then(|| self.span() / f64::from(self.per_mm))
    }

    fn span(&self) -> f64 {
        (f64::from(self.max) - f64::from(self.min)).max(1.0)
    }

    /// Where a value lies between the ends, 0…1; beyond them outside of that.
    fn share(&self, value: i32) -> f64 {
        (f64::from(value) - f64::from(self.min)) / self.span()
    }
}

/// Where a device's surface lies in the workspace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    /// Its lower left corner.
    pub corner: Point,
    /// Width and height, mm.
    pub size_mm: [f64; 2],
}

impl Area {
    /// Where the surface lies when nobody says so.
    pub fn usual(axes: [AxisRange; 2], workspace_mm: [f64; 2]) -> Self {
        let size_mm = match axes.map(|axis| axis.length_mm()) {
            [Some(width_mm), Some(height_mm)] => [width_mm, height_mm],
            _ => workspace_mm,
        };
        let [x_mm, y_mm] = [0, 1].map(|axis| (workspace_mm[axis] - size_mm[axis]) / 2.0);
        Self {
            corner: Point::new(x_mm, y_mm),
            size_mm,
        }
    }

    /// The place of a report's coordinates.
    pub(super) fn place(&self, axes: &[AxisRange; 2], [x, y]: [i32; 2]) -> Point {
        let [across, down] = [axes[0].share(x), axes[1].share(y)];
        Point::new(
            self.corner.x_mm + across * self.size_mm[0],
            self.corner.y_mm + (1.0 - down) * self.size_mm[1],
        )
    }

    /// The area of `[x, y, width, height]`, mm of the workspace.
    ///
    /// # Errors
    /// A number that is none, or nothing between the edges.
    pub fn of(numbers: [f64; 4]) -> Result<Self, InputError> {
        let [x_mm, y_mm, width_mm, height_mm] = numbers;
        let is_area = numbers.iter().all(|n| n.is_finite()) && width_mm > 0.0 && height_mm > 0.0;
        let text = || numbers.map(|n| n.to_string()).join(",");
        let area = is_area.then_some(Self {
            corner: Point::new(x_mm, y_mm),
            size_mm: [width_mm, height_mm],
        });
        area.ok_or_else(|| InputError::Area(text()))
    }

    /// `[x, y, width, height]`, mm of the workspace.
    pub fn numbers(&self) -> [f64; 4] {
        let [width_mm, height_mm] = self.size_mm;
        [self.corner.x_mm, self.corner.y_mm, width_mm, height_mm]
    }
}

impl FromStr for Area {
    type Err = InputError;

    /// `X,Y,WIDTH,HEIGHT`, mm of the workspace.
    fn from_str(text: &str) -> Result<Self, InputError> {
        let wrong = || InputError::Area(text.to_owned());
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        let numbers = numbers.ok().and_then(|numbers| numbers.try_into().ok());
        // What is refused is told as it was written.
        numbers
            .and_then(|numbers| Self::of(numbers).ok())
            .ok_or_else(wrong)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATED: [AxisRange; 2] = [
        AxisRange {
            min: 0,
            max: 16_000,
            per_mm: 100,
        },
        AxisRange {
            min: 0,
            max: 10_000,
            per_mm: 100,
        },
    ];

    #[test]
    fn a_stated_resolution_keeps_millimetres_and_y_points_up() {
        let area = Area::usual(STATED, [260.0, 260.0]);
        assert_eq!(
            (area.size_mm, area.corner),
            ([160.0, 100.0], Point::new(50.0, 80.0))
        );
        assert_eq!(area.place(&STATED, [8000, 5000]), Point::new(130.0, 130.0));
        assert_eq!(area.place(&STATED, [0, 0]), Point::new(50.0, 180.0));
        let [a, b] = [[0, 10_000], [100, 10_000]].map(|at| area.place(&STATED, at));
        assert!(
            (b.x_mm - a.x_mm - 1.0).abs() < 1e-12,
            "a millimetre is a millimetre"
        );
    }

    #[test]
    fn an_unknown_resolution_lays_the_surface_over_the_workspace() {
        let axes = STATED.map(|axis| AxisRange { per_mm: 0, ..axis });
        let area = Area::usual(axes, [200.0, 100.0]);
        assert_eq!(area.place(&axes, [16_000, 0]), Point::new(200.0, 100.0));
        let empty = [AxisRange::default(); 2];
        let place = Area::usual(empty, [200.0, 100.0]).place(&empty, [0, 0]);
        assert!(place.is_finite(), "{place:?}");
    }

    #[test]
    fn an_area_is_read_or_refused_by_name() {
        let area: Area = "10, 20,30,40.5".parse().unwrap();
        assert_eq!(area.corner, Point::new(10.0, 20.0));
        assert_eq!(area.place(&STATED, [0, 10_000]), Point::new(10.0, 20.0));
        for wrong in ["", "1,2,3", "1,2,3,0", "1,2,nan,4", "1,2,3,4,5", "a,b,c,d"] {
            let error = wrong.parse::<Area>().unwrap_err().to_string();
            assert!(
                error.contains(wrong) && error.contains("X,Y,WIDTH"),
                "{error}"
            );
        }
    }
}
