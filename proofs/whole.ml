(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* zarith's whole numbers under a name that Coq's extraction has no module of. *)
include Z
