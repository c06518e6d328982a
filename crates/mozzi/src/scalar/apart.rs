//! Passes that several quantities share.

/// A pass over the robot that several quantities share: for each number type a function of its own, compiled once. Only
/// numbers that are [in place](crate::Scalar::IN_PLACE) have a copy of it in every entry.
macro_rules! apart {
    (
        $(#[$attribute:meta])*
        $visibility:vis fn $pass:ident<S: Scalar + From<C>, C: Scalar>($($argument:ident: $Type:ty),* $(,)?) $body:block
    ) => {
        $(#[$attribute])*
        #[cfg_attr(not(debug_assertions), inline(always))]
        #[allow(clippy::too_many_arguments)]
        $visibility fn $pass<S: Scalar + From<C>, C: Scalar>($($argument: $Type),*) {
            #[cfg_attr(not(debug_assertions), inline(always))]
            #[allow(clippy::too_many_arguments)]
            fn here<S: Scalar + From<C>, C: Scalar>($($argument: $Type),*) $body

            #[inline(never)]
            #[allow(clippy::too_many_arguments)]
            fn apart<S: Scalar + From<C>, C: Scalar>($($argument: $Type),*) {
                here($($argument),*);
            }

            if S::IN_PLACE { here($($argument),*) } else { apart($($argument),*) }
        }
    };
}
pub(crate) use apart;
