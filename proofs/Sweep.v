(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Certificates that moving bodies never meet: for each piece of time and each two parts a direction that parts them. *)
Require Import Reals QArith Qreals List Bool Arith Lra Psatz.
From ExactVO Require Import Theorems Plane Parity Route.
Import ListNotations.
Open Scope R_scope.

(* --- Places in fractions --- *)
(* At a moment; of a trip without duration its start or its goal. *)
Definition qplace (m : trip) (t : Q) (at_end : bool) : point :=
  if qeq (leave m) (arrive m) then (if at_end then goal m else start m)
  else let u := qmul (qsub t (leave m)) (Qinv (qsub (arrive m) (leave m))) in
    (qadd (fst (start m)) (qmul u (qsub (fst (goal m)) (fst (start m)))), qadd (snd (start m)) (qmul u (qsub (snd (goal m)) (snd (start m))))).

Lemma qeq_iff a b : qeq a b = true <-> Q2R a = Q2R b.
Proof.
  split; [apply qeq_R|]. intro h. unfold qeq. apply andb_true_iff. rewrite !qle_iff. lra.
Qed.
Lemma qplace_ok m t e : real (qplace m t e) = at_time m (Q2R t) (if e then 1 else 0).
Proof.
  unfold qplace, at_time. destruct (qeq (leave m) (arrive m)) eqn:h.
  - apply qeq_R in h. destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))); [|contradiction]. destruct e; [now rewrite mix_1|now rewrite mix_0].
  - assert (k : Q2R (leave m) <> Q2R (arrive m)) by (intro k; apply qeq_iff in k; congruence).
    destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))); [contradiction|].
    unfold mix, add, scale, real; cbn [fst snd]. rewrite !Q2R_add, !Q2R_mul, !Q2R_sub.
    rewrite Q2R_inv; [|intro z; apply k; apply Qeq_eqR in z; rewrite Q2R_sub, Q2R_0 in z; lra]. rewrite Q2R_sub.
    assert (Q2R (arrive m) - Q2R (leave m) <> 0) by lra. f_equal; field; assumption.
Qed.

(* Between two moments a body is between its places at these. *)
Definition share (m : trip) (from to : Q) (t s : R) : R := if Req_EM_T (Q2R from) (Q2R to) then s else (t - Q2R from) / (Q2R to - Q2R from).
Lemma at_share m from to t s : Q2R (leave m) <= Q2R from -> Q2R to <= Q2R (arrive m) -> Q2R from <= t <= Q2R to ->
  at_time m t s = mix (share m from to t s) (real (qplace m from false)) (real (qplace m to true)).
Proof.
  intros hl ha ht. rewrite !qplace_ok. unfold at_time, share.
  destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))) as [e|n], (Req_EM_T (Q2R from) (Q2R to)) as [f|f].
  - now rewrite mix_0, mix_1.
  - exfalso. apply f. lra.
  - replace t with (Q2R from) by lra. rewrite f. unfold mix, add, scale; simpl. f_equal; ring.
  - rewrite mix_mix. f_equal. field. lra.
Qed.
Lemma share_ok m from to t s : 0 <= s <= 1 -> Q2R from <= t <= Q2R to -> 0 <= share m from to t s <= 1.
Proof. intros hs ht. unfold share. destruct (Req_EM_T (Q2R from) (Q2R to)); [assumption|]. apply share_bounds; lra. Qed.

(* --- One separation --- *)
(* By how much n parts them if the difference of the places is d. *)
Definition gap_along (n d : point) (p q : part) : option Q :=
  match corners p, corners q with
  | v :: vs, w :: ws => Some (qsub (qadd (pdot n d) (lowest n v vs)) (highest n w ws))
  | _, _ => None
  end.
Definition wide (n : point) (reaches width : Q) (gap : option Q) : bool :=
  match gap with
  | None => false
  | Some g => qlt 0 g && (let m := qadd reaches width in let left := qmul g g in let right := qmul (qmul m m) (pdot n n) in
      if qlt 0 width then qle right left else qlt right left)
  end.
Definition separates (a b : trip) (p q : part) (s : separation) : bool :=
  let n := direction s in let r := qadd (reach p) (reach q) in
  qle 0 (reach p) && qle 0 (reach q) && qle 0 (width s)
  && wide n r (width s) (gap_along n (psub (qplace a (since s) false) (qplace b (since s) false)) p q)
  && wide n r (width s) (gap_along n (psub (qplace a (until s) true) (qplace b (until s) true)) p q).

Lemma gap_ok n d p q g x y : gap_along n d p q = Some g -> hull (corners p) x -> hull (corners q) y ->
  Q2R g <= dot (real n) (sub (add (real d) x) y).
Proof.
  unfold gap_along. intros h hx hy. destruct (corners p) as [|v vs]; [discriminate|]. destruct (corners q) as [|w ws]; [discriminate|].
  injection h as h. subst g. rewrite Q2R_sub, Q2R_add, Q2R_dot, dot_sub, dot_add.
  pose proof (hull_above (real n) _ _ (lowest_ok n vs v) x hx). pose proof (hull_below (real n) _ _ (highest_ok n ws w) y hy). lra.
Qed.
Lemma wide_ok n r width gap : 0 <= Q2R r -> 0 <= Q2R width -> wide n r width gap = true ->
  exists g, gap = Some g /\ 0 < Q2R g /\ Q2R r * Q2R r * dot (real n) (real n) < Q2R g * Q2R g.
Proof.
  intros r0 w0 h. unfold wide in h. destruct gap as [g|]; [|discriminate]. exists g. split; [reflexivity|].
  apply andb_true_iff in h. destruct h as [g0 h]. apply qlt_R in g0. rewrite Q2R_0 in g0. split; [assumption|].
  pose proof (dot_self (real n)) as nn. destruct (qlt 0 width) eqn:e.
  - apply qlt_R in e. apply qle_R in h. rewrite !Q2R_mul, Q2R_dot, Q2R_add in h. rewrite Q2R_0 in e.
    destruct (Rle_lt_or_eq_dec _ _ nn) as [n0|n0]; [|rewrite <- n0, Rmult_0_r; now apply Rmult_lt_0_compat].
    apply Rlt_le_trans with (2 := h). apply Rmult_lt_compat_r; [assumption|]. nra.
  - apply qlt_R in h. rewrite !Q2R_mul, Q2R_dot, Q2R_add in h. apply Rle_lt_trans with (2 := h). apply Rmult_le_compat_r; [assumption|]. nra.
Qed.

Definition strictly_apart (r : R) (x y : vec) := r * r < dot (sub x y) (sub x y).
Lemma far_strict n z r g : 0 < g -> r * r * dot n n < g * g -> g <= dot n z -> r * r < dot z z.
Proof.
  intros g0 h k. assert (k2 : g * g <= dot n z * dot n z) by nra. pose proof (cauchy_schwarz n z). pose proof (dot_self n). pose proof (dot_self z).
  destruct (Rlt_or_le (r * r) (dot z z)); [assumption|]. exfalso. nra.
Qed.

Definition parted_between (a b : trip) (p q : part) (t s : R) := forall x y, hull (corners p) x -> hull (corners q) y ->
  strictly_apart (Q2R (reach p) + Q2R (reach q)) (add (at_time a t s) x) (add (at_time b t s) y).
Lemma separates_ok a b p q s : separates a b p q s = true -> 
  Q2R (leave a) <= Q2R (since s) -> Q2R (until s) <= Q2R (arrive a) -> Q2R (leave b) <= Q2R (since s) -> Q2R (until s) <= Q2R (arrive b) ->
  0 <= Q2R (reach p) /\ 0 <= Q2R (reach q) /\ forall t u, Q2R (since s) <= t <= Q2R (until s) -> 0 <= u <= 1 -> parted_between a b p q t u.
Proof.
  unfold separates. intros h la aa lb ab.
  apply andb_true_iff in h; destruct h as [h k1]. apply andb_true_iff in h; destruct h as [h k0]. apply andb_true_iff in h; destruct h as [h w0].
  apply andb_true_iff in h; destruct h as [p0 q0]. apply qle_R in p0, q0, w0. rewrite Q2R_0 in p0, q0, w0. split; [assumption|]. split; [assumption|].
  assert (r0 : 0 <= Q2R (qadd (reach p) (reach q))) by (rewrite Q2R_add; lra).
  destruct (wide_ok _ _ _ _ r0 w0 k0) as [g [eg [gp gh]]]. destruct (wide_ok _ _ _ _ r0 w0 k1) as [f [ef [fp fh]]]. clear k0 k1.
  rewrite Q2R_add in gh, fh. intros t u ht hu x y hx hy.
  assert (kg := gap_ok _ _ _ _ _ _ _ eg hx hy). assert (kf := gap_ok _ _ _ _ _ _ _ ef hx hy). rewrite real_sub in kg, kf.
  unfold strictly_apart. rewrite (at_share a (since s) (until s) t u), (at_share b (since s) (until s) t u) by assumption.
  change (share b (since s) (until s) t u) with (share a (since s) (until s) t u).
  assert (hl := share_ok a (since s) (until s) t u hu ht). set (l := share a (since s) (until s) t u) in *.
  set (a0 := real (qplace a (since s) false)) in *. set (a1 := real (qplace a (until s) true)) in *.
  set (b0 := real (qplace b (since s) false)) in *. set (b1 := real (qplace b (until s) true)) in *. set (n := real (direction s)) in *.
  assert (e : dot n (sub (add (mix l a0 a1) x) (add (mix l b0 b1) y)) =
    (1 - l) * dot n (sub (add (sub a0 b0) x) y) + l * dot n (sub (add (sub a1 b1) x) y)) by (unfold dot, sub, add, mix, scale; simpl; ring).
  destruct (Rle_or_lt (Q2R g) (Q2R f)).
  - apply (far_strict n _ _ (Q2R g)); [assumption|assumption|rewrite e; nra].
  - apply (far_strict n _ _ (Q2R f)); [assumption|assumption|rewrite e; nra].
Qed.

(* --- A list of them, maybe with more than that (`of` leaves it away): of each two parts in turn, without a gap --- *)
Fixpoint taken {S} (of : S -> separation) (fits : S -> bool) (from to : Q) (l : list S) : option (list S) :=
  match l with
  | [] => None
  | x :: r => let s := of x in
      if qeq (since s) from && qle (since s) (until s) && qle (until s) to && fits x
      then if qeq (until s) to then Some r else taken of fits (until s) to r else None
  end.
Lemma taken_ok {S} (of : S -> separation) fits to l : forall from rest, taken of fits from to l = Some rest -> incl rest l /\ forall t, Q2R from <= t <= Q2R to ->
  exists x, In x l /\ fits x = true /\ Q2R from <= Q2R (since (of x)) /\ Q2R (until (of x)) <= Q2R to /\ Q2R (since (of x)) <= t <= Q2R (until (of x)).
Proof.
  induction l as [|x r ih]; intros from rest h; [discriminate|]. simpl in h.
  destruct (qeq (since (of x)) from) eqn:e; [|discriminate]. destruct (qle (since (of x)) (until (of x))) eqn:o; [|discriminate].
  destruct (qle (until (of x)) to) eqn:u; [|discriminate]. destruct (fits x) eqn:fs; [|discriminate]. simpl in h.
  apply qeq_R in e. apply qle_R in o, u. destruct (qeq (until (of x)) to) eqn:d.
  - injection h as h. subst. apply qeq_R in d. split; [apply incl_tl, incl_refl|]. intros t ht. exists x. split; [now left|]. split; [assumption|]. repeat split; lra.
  - destruct (ih _ _ h) as [i k]. split; [now apply incl_tl|]. intros t ht.
    destruct (Rle_or_lt t (Q2R (until (of x)))) as [l|l]; [exists x; split; [now left|]; split; [assumption|]; repeat split; lra|].
    destruct (k t) as [y [h0 [h1 [h2 [h3 h4]]]]]; [lra|]. exists y. split; [now right|]. split; [assumption|]. repeat split; lra.
Qed.

Definition numbered {A} (l : list A) : list (nat * A) := combine (seq 0 (length l)) l.
Definition pairs {A B} (l : list A) (m : list B) : list ((nat * A) * (nat * B)) := list_prod (numbered l) (numbered m).
Definition of_pair {S} (of : S -> separation) (i j : nat) (fits : S -> bool) (x : S) : bool := Nat.eqb (part_no (of x)) i && Nat.eqb (other_no (of x)) j && fits x.
Fixpoint all_taken {A B S} (of : S -> separation) (fits : A -> B -> S -> bool) (from to : Q) (ps : list ((nat * A) * (nat * B))) (l : list S) : bool :=
  match ps with
  | [] => match l with [] => true | _ => false end
  | ((i, p), (j, q)) :: ps =>
      match taken of (of_pair of i j (fits p q)) from to l with
      | Some rest => all_taken of fits from to ps rest
      | None => false
      end
  end.
Definition sweep (a b : trip) (l : list separation) : bool :=
  let from := qmax (leave a) (leave b) in let to := qmin (arrive a) (arrive b) in
  if qlt to from then match l with [] => true | _ => false end else all_taken (fun s => s) (separates a b) from to (pairs (parts a) (parts b)) l.

Lemma in_numbered {A} (l : list A) x : In x l -> exists i, In (i, x) (numbered l).
Proof.
  unfold numbered. generalize 0%nat. induction l as [|y l ih]; intros k h; [destruct h|]. simpl.
  destruct h as [e|h]; [subst; exists k; now left|]. destruct (ih (S k) h) as [i hi]. exists i. now right.
Qed.
Lemma all_taken_ok {A B S} of (fits : A -> B -> S -> bool) from to ps : forall l, all_taken of fits from to ps l = true ->
  forall i p j q, In ((i, p), (j, q)) ps -> exists m rest, incl m l /\ taken of (of_pair of i j (fits p q)) from to m = Some rest.
Proof.
  induction ps as [|[[i0 p0] [j0 q0]] ps ih]; intros l h i p j q hin; [destruct hin|]. simpl in h.
  destruct (taken _ _ from to l) as [rest|] eqn:e; [|discriminate]. destruct hin as [eq|hin]; [injection eq as; subst; exists l, rest; split; [apply incl_refl|assumption]|].
  destruct (ih rest h i p j q hin) as [m [r [hm hr]]]. exists m, r. split; [|assumption]. apply incl_tran with (1 := hm). now apply (taken_ok _ _ _ _ _ _ e).
Qed.
(* Of each two parts one fits at each moment. *)
Lemma all_taken_fits {A B S} of (fits : A -> B -> S -> bool) from to (ps : list A) (qs : list B) l : all_taken of fits from to (pairs ps qs) l = true ->
  forall p q t, In p ps -> In q qs -> Q2R from <= t <= Q2R to ->
  exists x, In x l /\ fits p q x = true /\ Q2R from <= Q2R (since (of x)) /\ Q2R (until (of x)) <= Q2R to /\ Q2R (since (of x)) <= t <= Q2R (until (of x)).
Proof.
  intros h p q t hp hq ht. destruct (in_numbered _ _ hp) as [i hi]. destruct (in_numbered _ _ hq) as [j hj].
  destruct (all_taken_ok _ _ _ _ _ _ h i p j q) as [l' [rest [hl k]]]; [now apply in_prod|].
  destruct (taken_ok _ _ _ _ _ _ k) as [_ some]. destruct (some t ht) as [x [hx [hs more]]]. apply andb_true_iff in hs. exists x. split; [now apply hl|]. now split.
Qed.

Lemma sweep_parts a b l : sweep a b l = true -> forall t s p q, under_way a t -> under_way b t -> 0 <= s <= 1 -> In p (parts a) -> In q (parts b) ->
  0 <= Q2R (reach p) /\ 0 <= Q2R (reach q) /\ parted_between a b p q t s.
Proof.
  unfold sweep. intros h t u p q ua ub hu hp hq. unfold under_way in ua, ub.
  set (from := qmax (leave a) (leave b)) in *. set (to := qmin (arrive a) (arrive b)) in *.
  assert (ef : Q2R (leave a) <= Q2R from /\ Q2R (leave b) <= Q2R from /\ (Q2R from <= t)).
  { unfold from. rewrite Q2R_max. repeat split; [apply Rmax_l|apply Rmax_r|]. apply Rmax_lub; lra. }
  assert (et : Q2R to <= Q2R (arrive a) /\ Q2R to <= Q2R (arrive b) /\ (t <= Q2R to)).
  { unfold to. rewrite Q2R_min. repeat split; [apply Rmin_l|apply Rmin_r|]. apply Rmin_glb; lra. }
  destruct (qlt to from) eqn:e; [apply qlt_R in e; exfalso; lra|].
  destruct (all_taken_fits _ _ _ _ _ _ _ h p q t hp hq) as [s [_ [hs [s1 [s2 s3]]]]]; [lra|].
  apply separates_ok in hs; [|lra|lra|lra|lra].
  destruct hs as [p0 [q0 hs]]. split; [assumption|]. split; [assumption|]. now apply hs.
Qed.

Lemma no_common (r q : R) u v z : 0 <= r -> 0 <= q -> strictly_apart (r + q) u v ->
  dot (sub z u) (sub z u) <= r * r -> dot (sub z v) (sub z v) <= q * q -> False.
Proof.
  unfold strictly_apart. intros r0 q0 h hu hv. assert (k := bounded_dot (sub u z) (sub z v) r q r0 q0).
  assert (e : dot (sub u z) (sub u z) = dot (sub z u) (sub z u)) by (unfold dot, sub; simpl; ring). rewrite e in k. specialize (k hu hv).
  assert (f : dot (sub u v) (sub u v) = dot (sub z u) (sub z u) + 2 * dot (sub u z) (sub z v) + dot (sub z v) (sub z v)) by (unfold dot, sub; simpl; ring).
  rewrite f in h. nra.
Qed.

Theorem sweep_sound a b l : sweep a b l = true -> never_meet a b.
Proof.
  intros h t s x ua ub hs [p [y [hp [hy dy]]]] [q [z [hq [hz dz]]]].
  destruct (sweep_parts _ _ _ h t s p q ua ub hs hp hq) as [p0 [q0 k]]. apply (no_common _ _ _ _ x p0 q0 (k y z hy hz) dy dz).
Qed.

(* --- Past an obstacle: its edges are bodies at rest, and no part begins inside --- *)
Definition at_rest (m : trip) (es : list edge) : trip :=
  {| leave := leave m; arrive := arrive m; start := (0, 0)%Q; goal := (0, 0)%Q; parts := map (fun e => {| corners := [fst e; snd e]; reach := 0%Q |}) es |}.
Definition padd (a b : point) : point := (qadd (fst a) (fst b), qadd (snd a) (snd b)).
Definition begins_outside (place : point) (ps : list part) (o : obstacle) (es : list edge) : bool :=
  match o with
  | Wall _ => true
  | Solid _ => forallb (fun p => match corners p with [] => false | v :: _ => negb (qodd es (padd place v)) end) ps
  end.
Definition sweep_past (m : trip) (o : obstacle) (l : list separation) : bool :=
  let es := edges_of o in sweep m (at_rest m es) l && begins_outside (start m) (parts m) o es.

Lemma rest_place m es t s : at_time (at_rest m es) t s = (0, 0).
Proof. unfold at_time, at_rest, mix, add, scale, real; simpl. rewrite Q2R_0. f_equal; ring. Qed.

Lemma past_edges m o l : sweep m (at_rest m (edges_of o)) l = true -> forall t s x e, under_way m t -> 0 <= s <= 1 -> covers m t s x -> In e (edges_of o) -> ~ on e x.
Proof.
  intros h t s x e ut hs c he ox. apply (sweep_sound _ _ _ h t s x ut ut hs c).
  exists {| corners := [fst e; snd e]; reach := 0%Q |}, x. split; [simpl; apply in_map_iff; now exists e|]. split; [exact ox|].
  rewrite rest_place. simpl. rewrite Q2R_0. unfold dot, sub, add; simpl. nra.
Qed.

Lemma straight_even es x y : closed es -> (forall u, 0 <= u <= 1 -> off es (mix u x y)) -> odd es x = false -> odd es y = false.
Proof.
  intros c h k. rewrite <- (mix_0 x y) in k. rewrite <- (mix_1 x y). rewrite <- k. symmetry.
  apply (odd_path es (fun t => mix t x y) c (mix_continuous _ _) h).
Qed.

Lemma begins_outside_ok place ps rs : begins_outside place ps (Solid rs) (edges_of (Solid rs)) = true -> forall p, In p ps ->
  exists v, hull (corners p) v /\ odd (edges_of (Solid rs)) (add (real place) v) = false.
Proof.
  unfold begins_outside. intros h p hp. rewrite forallb_forall in h. specialize (h p hp). destruct (corners p) as [|v vs]; [discriminate|].
  apply negb_true_iff in h. rewrite qodd_ok in h. exists (real v). split; [apply corner; now left|]. rewrite <- h. f_equal.
  unfold padd, add, real; simpl. now rewrite !Q2R_add.
Qed.

(* What holds of one point of a part holds of the whole part, out to its reach, if no edge comes near. *)
Lemma whole_part_even es (place : vec -> vec) cs r v y x : closed es -> 0 <= r -> (forall u a b, place (mix u a b) = mix u (place a) (place b)) ->
  (forall z q, hull cs z -> dot (sub q (place z)) (sub q (place z)) <= r -> off es q) -> hull cs v -> hull cs y ->
  dot (sub x (place y)) (sub x (place y)) <= r -> odd es (place v) = false -> odd es x = false.
Proof.
  intros cl r0 affine far hv hy hx h.
  assert (at_part : forall z, hull cs z -> off es (place z)).
  { intros z hz. apply (far z _ hz). replace (dot (sub (place z) (place z)) (sub (place z) (place z))) with 0 by (unfold dot, sub; simpl; ring). assumption. }
  assert (b : odd es (place y) = false).
  { apply (straight_even es (place v)); [assumption| |assumption]. intros u hu. rewrite <- affine. apply at_part. now apply chord. }
  apply (straight_even es (place y)); [assumption| |exact b]. intros u hu. apply (far y _ hy). set (c := place y) in *.
  replace (dot (sub (mix u c x) c) (sub (mix u c x) c)) with (u * u * dot (sub x c) (sub x c)) by (unfold dot, sub, mix, add, scale; simpl; ring).
  pose proof (dot_self (sub x c)). assert (u * u <= 1) by nra. nra.
Qed.

Theorem sweep_past_sound m o l : sweep_past m o l = true -> stays_out m o.
Proof.
  unfold sweep_past. intro h. apply andb_true_iff in h. destruct h as [h b]. assert (k := past_edges m o l h).
  intros t s x ut hs c. split; [|intros e he; now apply (k t s x e)].
  intros o' [eo|[]]. subst o'. destruct o as [w|rs]; [exact I|]. set (es := edges_of (Solid rs)) in *.
  assert (cl : closed es) by apply rings_closed. destruct c as [p [y [hp [hy dy]]]].
  destruct (begins_outside_ok _ _ _ b p hp) as [v [hv bv]]. fold es in bv.
  assert (r0 : 0 <= Q2R (reach p) * Q2R (reach p)) by nra.
  assert (far : forall t s z q, under_way m t -> 0 <= s <= 1 -> hull (corners p) z ->
    dot (sub q (add (at_time m t s) z)) (sub q (add (at_time m t s) z)) <= Q2R (reach p) * Q2R (reach p) -> off es q).
  { intros t' s' z q ut' hs' hz hq e he. apply (k t' s' _ e ut' hs'); [|exact he]. now exists p, z. }
  apply (whole_part_even es (add (at_time m t s)) (corners p) (Q2R (reach p) * Q2R (reach p)) v y); try assumption.
  { intros u a c. unfold mix, add, scale; simpl. f_equal; ring. }
  { intros z q. now apply far. }
  (* Along the trip. *)
  assert (here : forall t s, under_way m t -> 0 <= s <= 1 -> off es (add (at_time m t s) v)).
  { intros t' s' ut' hs'. apply (far t' s' v); [assumption|assumption|assumption|].
    replace (dot (sub (add (at_time m t' s') v) (add (at_time m t' s') v)) (sub (add (at_time m t' s') v) (add (at_time m t' s') v))) with 0
      by (unfold dot, sub; simpl; ring). assumption. }
  apply (straight_even es (add (real (start m)) v)); [assumption| |exact bv].
  intros u hu. unfold under_way in ut. destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))) as [e|n].
  - replace (mix u (add (real (start m)) v) (add (at_time m t s) v)) with (add (at_time m t (u * s)) v).
    + apply here; [assumption|nra].
    + unfold at_time. destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))); [|contradiction]. unfold mix, add, scale; simpl. f_equal; ring.
  - replace (mix u (add (real (start m)) v) (add (at_time m t s) v)) with (add (at_time m (Q2R (leave m) + u * (t - Q2R (leave m))) s) v).
    + apply here; [|assumption]. unfold under_way. split; [nra|]. assert (u * (t - Q2R (leave m)) <= 1 * (t - Q2R (leave m))) by (apply Rmult_le_compat_r; lra). lra.
    + unfold at_time. destruct (Req_EM_T (Q2R (leave m)) (Q2R (arrive m))); [contradiction|]. unfold mix, add, scale; simpl. f_equal; field; lra.
Qed.
