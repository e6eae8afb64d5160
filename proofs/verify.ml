(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* exactvo-verify: certificates, answers of `exactvo lp` and recordings, decided by checkers that are proven in Coq. *)
let () = Recordings.main ()
