(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Doubles as fractions. Every finite double is a whole number over a power of two, so that the numbers of a certificate
   get one denominator, with which the checkers add and compare without multiplying. *)
open Checker

exception Malformed

(* |x| = whole_of x * 2^-(scale_of x) *)
let exponent x = Int64.to_int (Int64.shift_right_logical (Int64.bits_of_float x) 52) land 0x7FF
let scale_of x = let e = exponent x in if e = 0x7FF then raise Malformed else if e = 0 then 1074 else 1075 - e
let whole_of x = let fraction = Int64.to_int (Int64.bits_of_float x) land 0xFFFFFFFFFFFFF in if exponent x = 0 then fraction else fraction lor (1 lsl 52)

(* The larger of a number and of the bits behind the point that x needs. *)
let bits_at_least most (x : float) =
  let b = scale_of x in
  if b <= most || x = 0. then most else begin
    let w = ref (whole_of x) and b = ref b in
    while !b > most && !w land 1 = 0 do w := !w lsr 1; decr b done;
    !b
  end
let bits_of = bits_at_least 0

(* The fractions of doubles that need at most so many bits behind the point. *)
let over bits =
  let qden = Whole.shift_left Whole.one bits in
  fun x ->
    let w = whole_of x and more = bits - scale_of x in
    let w = if x < 0. then - w else w in
    let qnum = if more >= 0 then Whole.shift_left (Whole.of_int w) more
      else if w = 0 then Whole.zero
      else if more > -53 && w land ((1 lsl - more) - 1) = 0 then Whole.of_int (w asr - more) else raise Malformed in
    { qnum; qden }

let fractions xs = over (List.fold_left bits_at_least 0 xs)
let rational x = fractions [x] x
let to_q a = Q.make a.qnum a.qden
let of_q a = { qnum = Q.num a; qden = Q.den a }

(* a - b, nearly *)
let difference (a : q) (b : q) =
  let num, den = if a.qden == b.qden then (Whole.sub a.qnum b.qnum, a.qden)
    else (Whole.sub (Whole.mul a.qnum b.qden) (Whole.mul b.qnum a.qden), Whole.mul a.qden b.qden) in
  if Whole.numbits den < 1000 then Whole.to_float num /. Whole.to_float den else Q.to_float (Q.make num den)
