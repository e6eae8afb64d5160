(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* zarith's whole numbers under a name that Coq's extraction has no module of. *)
include Z

(* The numbers of a file share one denominator, so that mostly the addresses are equal already. *)
let equal a b = a == b || Z.equal a b
(* Without signs to round down is to cut off, which is quick for numbers of a machine word. *)
let fdiv a b = if Z.sign a >= 0 && Z.sign b > 0 then Z.div a b else Z.fdiv a b
