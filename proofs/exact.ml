(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Doubles as fractions. Every finite double is a whole number over a power of two, so that the numbers of a certificate
   get one denominator, with which the checkers add and compare without multiplying. *)
open Checker

exception Malformed

(* x = whole * 2^-bits, whole odd or 0 *)
let split x =
  if not (Float.is_finite x) then raise Malformed;
  let m, e = Float.frexp x in
  let w = ref (int_of_float (Float.ldexp m 53)) and b = ref (53 - e) in
  if !w = 0 then (0, 0) else begin
    while !w land 0xFF = 0 do w := !w asr 8; b := !b - 8 done;
    while !w land 1 = 0 do w := !w asr 1; decr b done;
    (!w, !b)
  end

let bits_of x = snd (split x)

(* The fractions of doubles that need at most so many bits behind the point. *)
let over bits =
  let qden = Whole.shift_left Whole.one bits in
  fun x -> let w, b = split x in { qnum = Whole.shift_left (Whole.of_int w) (bits - b); qden }

let fractions xs = over (List.fold_left (fun m x -> max m (bits_of x)) 0 xs)
let rational x = fractions [x] x
let to_q a = Q.make a.qnum a.qden
let of_q a = { qnum = Q.num a; qden = Q.den a }
